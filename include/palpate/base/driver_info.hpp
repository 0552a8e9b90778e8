#pragma once

#include <string>
#include <vector>

namespace palpate {

/// A driver of cameras or haptic devices.
struct DriverInfo {
  /// A camera or a haptic device that is there, though another program may use it.
  struct Device {
    std::string name;         ///< what open_camera() or open_device() takes
    std::string description;  ///< for people
  };

  std::string name;          ///< what open_camera() or open_device() takes, without a device
  std::string description;   ///< which devices these are
  bool available = true;     ///< is it in this build, and does it work?
  std::string missing = {};  ///< what is missing and what brings it, if it is not available
  std::vector<Device> devices = {};
};

}  // namespace palpate
