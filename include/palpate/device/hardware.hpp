#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/base/driver_info.hpp"
#include "palpate/device/device.hpp"

namespace palpate {

/// A driver: a connection to hardware whose calls may block. A ThreadedDevice makes a Device of it
/// that never blocks.
///
/// One thread at a time uses it. Opening it (a function of each driver's own) throws Error; the
/// destructor sets zero force and closes the hardware. Frame of all drivers, as the operator sits
/// in front of the device: x to the right, y away from the operator, z up.
class DeviceDriver {
 public:
  virtual ~DeviceDriver() = default;
  DeviceDriver(const DeviceDriver&) = delete;
  DeviceDriver& operator=(const DeviceDriver&) = delete;

  /// `rate`: exchanges per second that the hardware is made for; `delay`: its own, if known.
  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  /// Applies a force to the hand, N, and reads where the hand is; status and time of the result are
  /// not used. May wait for the hardware. The force is finite and not longer than
  /// info().maximum_force.
  /// @throws Error that states what failed and what to do. The driver is then closed.
  [[nodiscard]] virtual DeviceState exchange(const Eigen::Vector3d& force) = 0;
  /// The same with torque and grip, finite and no larger than info() has them; by default the force
  /// alone is applied.
  [[nodiscard]] virtual DeviceState exchange_wrench(const Wrench& wrench) {
    return exchange(wrench.force);
  }

 protected:
  DeviceDriver() = default;
};

struct ThreadedDeviceOptions {
  /// s after which a position is too old to be used; raised to 2.5 exchanges of slow devices.
  double state_timeout = 5e-3;
  double force_timeout = 5e-3;  ///< s after which a force is no longer applied: the servo is stuck
  double retry_interval = 1;    ///< s between attempts to reopen lost hardware
  bool threaded = true;  ///< false: no thread; the owner calls service(), as in simulated time
  /// Called first on the device's thread, to request a priority; does not throw.
  std::function<void()> begin = {};
};

/// Hardware with a thread of its own, so that no driver call can block the servo.
///
/// The thread exchanges forces and positions with the hardware at the hardware's rate. read() takes
/// the newest position, write() leaves a force for the next exchange; neither blocks, allocates or
/// locks.
///
/// Hardware may be unplugged, fail, stop answering, or report values that are not finite or
/// impossible for a hand (too far away, too fast, or a jump). None of this makes the device fail:
/// its status becomes `silent`, no force is applied, and the hardware is reopened as soon as it is
/// back. The first position after a silence still has status `silent`, so that what computes
/// forces receives the hand's position before any acts; a force is applied only to the
/// connection whose position it answers. A force that is not finite latches `failed`.
class ThreadedDevice final : public Device {
 public:
  /// Opens the driver. @throws Error with the reason when that fails.
  using Open = std::function<std::unique_ptr<DeviceDriver>()>;

  /// Opens the device. `clock` outlives it; DeviceState::time is its time.
  /// @throws Error when `open` does, an option is out of range, or no thread can be started.
  ThreadedDevice(Open open, WaitingClock& clock, ThreadedDeviceOptions options = {});
  /// Sets zero force and closes the hardware.
  ~ThreadedDevice() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override;
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override { write_wrench({.force = force}); }
  void write_wrench(const Wrench& wrench) noexcept override;
  /// Also why the device is silent. Any thread but the servo's.
  [[nodiscard]] std::string reason() const override;

  /// Makes one exchange with the hardware; if that is lost and the interval is over, tries once to
  /// reopen it. The device's own thread calls this; without one, the owner does.
  void service() noexcept;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

/// Opens hardware by name; it gets a thread of its own (ThreadedDevice).
///  - "forcedimension[:N]": Force Dimension's devices and the Novint Falcon; N counts from 0.
///    Options: library=PATH of libdhd.so.3.
///  - "openhaptics[:NAME]": 3D Systems' Touch and Touch X, SensAble's Phantoms; NAME as in the
///    maker's set-up, "Default Device" without. Options: library=PATH of libHD.so.
///  - "haply[:ID]": Haply's Inverse3; without an id the first one found. Options:
///    url=ws://HOST:PORT of its Inverse Service.
///  - "ros:PRESET": a device that a node of ROS 2 owns (docs/ros2.md). Options: ns=NAMESPACE,
///    delay=MS; of ros:generic pose=TOPIC, wrench=TOPIC, twist=TOPIC, joy=TOPIC.
/// Options follow as ",KEY=VALUE". All take profile=NAME (device_profile()), instead of the
/// kind that the device reports. `clock` outlives the device.
/// @throws Error when the name is none of these, or there is no such device; its message states
/// what to do.
[[nodiscard]] std::unique_ptr<ThreadedDevice> open_device(
    const std::string& name, WaitingClock& clock, const ThreadedDeviceOptions& options = {});

/// True for the name of a hardware driver, with any device and options.
[[nodiscard]] bool names_hardware(const std::string& name);

/// All hardware drivers, with the devices they find. Opens no device. May take a second.
[[nodiscard]] std::vector<DriverInfo> list_devices();

}  // namespace palpate
