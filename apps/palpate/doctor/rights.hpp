#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// Does a servo's thread get what it asks for, what do the limits say, and may real-time threads
/// run at all?
[[nodiscard]] Findings check_rights(const System& system, const RealtimeReport& report);

/// The command that lets this user run real-time threads and lock memory.
[[nodiscard]] std::string rights_command(const System& system);

}  // namespace palpate::app::doctor
