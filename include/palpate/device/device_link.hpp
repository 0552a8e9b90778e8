#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "palpate/device/device.hpp"

namespace palpate {

/// What hardware told in one exchange, device frame.
struct LinkReading {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< m/s
  std::uint32_t buttons = 0;                                        ///< bit k: button k is down
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< as DeviceState's
  double gripper = 0;                                               ///< opening, m
};

/// A connection to hardware that may make its caller wait: what a driver consists of. A
/// LinkedDevice makes a device of it that never waits.
///
/// One thread at a time uses it. Opening it (a driver's own function) throws Error; the destructor
/// brings the hardware to zero force and closes it. All drivers tell places as the operator sits
/// before the device: x to the right, y away, z up.
class DeviceLink {
 public:
  virtual ~DeviceLink() = default;
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;

  /// `rate`: exchanges a second that the hardware is made for; `delay`: its own, if it is known.
  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  /// Applies a force to the hand, N, and tells where the hand is. May wait for the hardware. The
  /// force is finite, and no longer than info().maximum_force.
  /// @throws Error that says what the hardware failed in and what to do. The link is given up then.
  [[nodiscard]] virtual LinkReading exchange(const Eigen::Vector3d& force) = 0;

 protected:
  DeviceLink() = default;
};

}  // namespace palpate
