#pragma once

#include <memory>

#include "device/device_name.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/device_link.hpp"
#include "palpate/device/open_device.hpp"

// The drivers of hardware. One that needs what a build may lack has two sources, of which the build
// takes one: DRIVER_link.cpp, or DRIVER_absent.cpp. A link may read the clock, which outlives it.
namespace palpate::device {

[[nodiscard]] DriverInfo forcedimension_driver();
/// Device: a number, from 0; options: library=PATH, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceLink> open_forcedimension(const DeviceName& name,
                                                              const Clock& clock);

[[nodiscard]] DriverInfo haply_driver();
/// Device: its id; options: url=ws://HOST:PORT, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceLink> open_haply(const DeviceName& name, const Clock& clock);

[[nodiscard]] DriverInfo openhaptics_driver();
/// Device: its name in the maker's set-up; options: library=PATH, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceLink> open_openhaptics(const DeviceName& name,
                                                           const Clock& clock);

}  // namespace palpate::device
