#pragma once

#include "apps/palpate/doctor/finding.hpp"
#include "apps/palpate/doctor/known_devices.hpp"
#include "apps/palpate/doctor/system.hpp"

namespace palpate::app::doctor {

/// The drivers of `palpate cameras`: which are there and find something, and which packages bring
/// the others. A driver that is missing is a problem where a camera for it is plugged in.
[[nodiscard]] Findings check_camera_drivers(const System& system, const std::vector<Found>& found);

}  // namespace palpate::app::doctor
