#pragma once

#include <string>
#include <vector>

namespace palpate {

/// A camera or a haptic device that is there, though another program may use it.
struct FoundDevice {
  std::string name;         ///< what open_camera() or open_device() takes
  std::string description;  ///< for people
};

/// A way to cameras or to haptic devices.
struct DriverInfo {
  std::string name;         ///< what open_camera() or open_device() takes, without a device
  std::string description;  ///< which devices these are
  bool available = true;    ///< is it in this build, and does it work?
  std::string missing;      ///< what is missing and what brings it, if it is not available
  std::vector<FoundDevice> devices;
};

}  // namespace palpate
