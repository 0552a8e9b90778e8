#pragma once

#include <memory>

#include "device/device_name.hpp"
#include "palpate/device/device_link.hpp"
#include "palpate/device/open_device.hpp"

// The drivers of hardware. One that needs what a build may lack has two sources, of which the build
// takes one: DRIVER_link.cpp, or DRIVER_absent.cpp.
namespace palpate::device {

[[nodiscard]] HapticDriver forcedimension_driver();
/// Device: a number, from 0; options: library=PATH, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceLink> open_forcedimension(const DeviceName& name);

[[nodiscard]] HapticDriver haply_driver();
/// Device: its id; options: url=ws://HOST:PORT, profile=NAME.
[[nodiscard]] std::unique_ptr<DeviceLink> open_haply(const DeviceName& name);

}  // namespace palpate::device
