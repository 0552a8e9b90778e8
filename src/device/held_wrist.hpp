// The wrist of a simulated device, and the hand that holds it.
#pragma once

#include <Eigen/Geometry>

#include "palpate/device/simulated.hpp"

namespace palpate {

/// A rigid body that turns about its handle, on the hand's spring and damper, with dry friction:
///
///   I w' + w x I w = tau - b w - f_c w/|w| + k_h e + b_h (w_h - w)
///
/// in the tool's axes; e: the turn to the hand's orientation. Real-time but for construction.
class HeldWrist {
 public:
  /// @throws Error when an option is out of its range.
  explicit HeldWrist(const SimulatedWrist& options);

  /// From the hand's orientation at the beginning of a step of `duration` (s) to that at its end,
  /// with a torque (N m, device's axes) that is held.
  void advance(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to,
               const Eigen::Vector3d& torque, double duration) noexcept;

  void put(const Eigen::Quaterniond& orientation) noexcept { orientation_ = orientation; }
  [[nodiscard]] const Eigen::Quaterniond& orientation() const noexcept { return orientation_; }
  /// That the torques have done, J.
  [[nodiscard]] double work() const noexcept { return work_; }
  /// What the encoders read: steps of the rotation vector from the device's axes.
  [[nodiscard]] Eigen::Quaterniond shown() const noexcept;

 private:
  void turn(const Eigen::Vector3d& torque, double duration) noexcept;
  [[nodiscard]] Eigen::Vector3d pull(const Eigen::Quaterniond& goal,
                                     const Eigen::Vector3d& goal_rate) const noexcept;

  SimulatedWrist options_;
  Eigen::Quaterniond orientation_;
  Eigen::Vector3d rate_;  // rad/s, in the tool's axes
  double work_ = 0;
};

}  // namespace palpate
