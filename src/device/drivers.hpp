#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "palpate/base/clock.hpp"
#include "palpate/base/driver_info.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate::device {

/// "DRIVER[:DEVICE][,KEY=VALUE]...", parsed.
struct DeviceName {
  std::string driver;
  std::string device;  ///< empty: the first one found
  std::map<std::string, std::string> options = {};

  /// The value of `key`, or `otherwise` if it is not given.
  [[nodiscard]] std::string option(const std::string& key, const std::string& otherwise = "") const;
};

/// @throws Error when an option has no value or is given twice.
[[nodiscard]] DeviceName parse_device_name(std::string_view name);

/// @throws Error when `name` has options other than `valid`, which the message lists.
void check_options(const DeviceName& name, std::initializer_list<std::string_view> valid);

/// How a device moves by its profile, as far as that says it: in a DeviceInfo, or in the options of
/// a device that have the same members.
template <class Limits>
void take_motion(const DeviceProfile& profile, Limits& limits) {
  limits.maximum_stiffness = profile.maximum_stiffness.value_or(limits.maximum_stiffness);
  limits.damping = profile.damping.value_or(limits.damping);
  limits.angular_damping = profile.angular_damping.value_or(limits.angular_damping);
  limits.mass = profile.mass.value_or(limits.mass);
  limits.rate = profile.rate.value_or(limits.rate);
  limits.delay = profile.delay;
  limits.workspace_radius = profile.workspace_radius.value_or(limits.workspace_radius);
}

/// The numbers of a profile for a device that is called `name`. Where the profile does not contain
/// the force, that of an unknown device is taken.
[[nodiscard]] DeviceInfo info_of(const DeviceProfile& profile, const std::string& name);
/// What motors of a wrist and of a gripper hold by that profile; where it does not say, those of an
/// unknown device.
void add_motors(DeviceInfo& info, const DeviceProfile& profile, bool wrist, bool gripper);

// The drivers of hardware: what each finds, and how it opens a device. Drivers that need a library
// at build time have a second source, DRIVER_absent.cpp, for builds without it. A driver may read
// the clock, which outlives it.

[[nodiscard]] DriverInfo list_forcedimension();
/// Device: a number, from 0; options: library=PATH, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceDriver> open_forcedimension(const DeviceName& name,
                                                                const Clock& clock);

[[nodiscard]] DriverInfo list_haply();
/// Device: its id; options: url=ws://HOST:PORT, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceDriver> open_haply(const DeviceName& name, const Clock& clock);

[[nodiscard]] DriverInfo list_ros();
/// Device: a preset of topics (docs/ros2.md); options: ns=, pose=, wrench=, twist=, joy= (topics),
/// delay=MS, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceDriver> open_ros(const DeviceName& name, const Clock& clock);

[[nodiscard]] DriverInfo list_openhaptics();
/// Device: its name in the maker's set-up; options: library=PATH, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceDriver> open_openhaptics(const DeviceName& name,
                                                             const Clock& clock);

}  // namespace palpate::device
