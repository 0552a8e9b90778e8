#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/known_devices.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// The vendors' libraries, and Haply's service: absent, broken or in which version; where a Touch
/// is plugged in, its set-up. Absence is a problem where a device needs it.
[[nodiscard]] Findings check_vendor_libraries(const System& system,
                                              const std::vector<Found>& found);

}  // namespace palpate::app::doctor
