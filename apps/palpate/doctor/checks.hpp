#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// Every check, area by area. `jitter`: s to measure for; 0 leaves that out.
[[nodiscard]] Findings check_all(const System& system, double jitter);

}  // namespace palpate::app::doctor
