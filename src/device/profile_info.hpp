#pragma once

#include <string>

#include "palpate/device/device.hpp"
#include "palpate/device/device_profile.hpp"

namespace palpate::device {

/// What a profile tells of a device that is called `name`. Where the profile does not know the
/// force, that of an unknown device is taken.
[[nodiscard]] DeviceInfo info_of(const DeviceProfile& profile, const std::string& name);

}  // namespace palpate::device
