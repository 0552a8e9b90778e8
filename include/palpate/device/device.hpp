#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

namespace palpate {

/// How a device is doing.
enum class DeviceStatus {
  ok,
  silent,    ///< not latched: the hand is not heard, so no force may be felt; what is told of its
             ///< place is the last that was known, or the first after the silence
  finished,  ///< a recording or a simulation has come to its end; the last state is repeated
  failed,    ///< latched: no force is applied any more; reason() says why
};

/// Will there be no more steps?
[[nodiscard]] constexpr bool has_ended(DeviceStatus status) noexcept {
  return status == DeviceStatus::finished || status == DeviceStatus::failed;
}

/// What one device can do.
struct DeviceInfo {
  std::string name;              ///< for messages
  double maximum_force = 0;      ///< N, continuous; 0: it renders no force
  double maximum_stiffness = 0;  ///< N/m at the hand that its maker allows; 0: not known
  double damping = 0;            ///< viscous, of the device by itself, N s/m; 0: not known
  double mass = 0;               ///< that the hand moves with it, kg; 0: not known
  double rate = 1000;            ///< steps a second that it is made for, Hz
  /// s from the reading of a place to its force's effect, the hold of the force not counted; unset:
  /// not known
  std::optional<double> delay = {};
  double workspace_radius = 0;     ///< of the largest ball in reach, m; 0: not known
  bool keeps_time = false;         ///< read() waits for, or defines, the next step by itself
  bool tells_orientation = false;  ///< of the tool
  bool has_gripper = false;        ///< whose opening it tells
};

/// What a device knows at the beginning of a step, in the device's own frame.
struct DeviceState {
  DeviceStatus status = DeviceStatus::ok;
  double time = 0;                                     ///< s, on the device's clock
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  std::uint32_t buttons = 0;                           ///< bit k: button k is down
  /// From the tool's axes to the device's, of unit length; the tool held straight, as the device's
  /// axes are, is the identity. The identity where the device does not tell it.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  double gripper = 0;  ///< opening between its fingers, m; 0 where there is none
};

/// A haptic device: tells where the hand is, applies a force to it. It may tell more (orientation,
/// gripper), but what it applies has three degrees of freedom: no torque is rendered.
///
/// One thread uses it, as a sequence of steps: read() once, then write() once. A driver may talk to
/// its hardware in either; a device that answers only when spoken to sends in write() and receives
/// in the next read(). Construction opens the device and throws Error; the destructor brings it to
/// zero force. Between them nothing throws: a failure is latched, read() then repeats the last
/// state with status `failed`, and write() does nothing.
class Device {
 public:
  virtual ~Device() = default;

  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  /// The newest state. May wait for the device's next step if `info().keeps_time`, no longer than
  /// two of its periods; never otherwise.
  [[nodiscard]] virtual DeviceState read() noexcept = 0;

  /// Applies a force to the hand, N, device frame, until the next write(). Forces that are not
  /// finite count as a failure; those above the device's maximum are its driver's to limit.
  virtual void write(const Eigen::Vector3d& force) noexcept = 0;

  /// Why the status is `failed`, or `silent`, and what to do; empty otherwise. Not real-time.
  [[nodiscard]] virtual std::string reason() const = 0;

 protected:
  Device() = default;
  Device(const Device&) = default;
  Device& operator=(const Device&) = default;
};

}  // namespace palpate
