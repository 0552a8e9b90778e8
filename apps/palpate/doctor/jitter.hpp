#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// How late the steps of a loop at 1 kHz came, with a histogram. The lateness holds one step at
/// least.
[[nodiscard]] Finding check_jitter(const System& system, const RealtimeTrial& trial);

}  // namespace palpate::app::doctor
