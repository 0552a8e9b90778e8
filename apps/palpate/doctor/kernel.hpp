#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// Is the kernel a real-time one?
[[nodiscard]] Finding check_preemption(const System& system);

/// Do processors slow down while a servo sleeps?
[[nodiscard]] Finding check_governor(const System& system);

/// Is reading the time fast?
[[nodiscard]] Finding check_clock_source(const System& system);

/// The command that brings a real-time kernel.
[[nodiscard]] std::string realtime_kernel_command(const System& system);

}  // namespace palpate::app::doctor
