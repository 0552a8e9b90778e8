#pragma once

#include <memory>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/base/driver_info.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/threaded_device.hpp"

namespace palpate {

/// Opens hardware by name; it gets a thread of its own (ThreadedDevice).
///  - "forcedimension[:N]": Force Dimension's devices and the Novint Falcon; N counts from 0.
///    Options: library=PATH of libdhd.so.3.
///  - "openhaptics[:NAME]": 3D Systems' Touch and Touch X, SensAble's Phantoms; NAME as in the
///    maker's set-up, "Default Device" without. Options: library=PATH of libHD.so.
///  - "haply[:ID]": Haply's Inverse3; without an id the first one found. Options:
///    url=ws://HOST:PORT of its Inverse Service.
///  - "ros:PRESET": a device that a node of ROS 2 owns (docs/ros2.md). Options: ns=NAMESPACE,
///  delay=MS; of ros:generic
///    pose=TOPIC, wrench=TOPIC, twist=TOPIC, joy=TOPIC.
/// Options follow as ",KEY=VALUE". All take profile=NAME (device_profile()), in place of the
/// kind that the device reports. `clock` outlives the device.
/// @throws Error when the name is none of these, or there is no such device; says what to do.
[[nodiscard]] std::unique_ptr<ThreadedDevice> open_device(
    const std::string& name, WaitingClock& clock, const ThreadedDeviceOptions& options = {});

/// True for the name of a hardware driver, with any device and options.
[[nodiscard]] bool names_hardware(const std::string& name);

/// All hardware drivers, with the devices they find. Opens no device. May take a second.
[[nodiscard]] std::vector<DriverInfo> list_devices();

}  // namespace palpate
