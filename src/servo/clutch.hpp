#pragma once

#include <Eigen/Core>

namespace palpate {

/// Lets a hand move without its tool. At the end of a device's reach, hold the clutch, move the
/// hand back, release it: the tool goes on from where it rested, further than any device reaches.
///
/// The tool is where the hand is, shifted by all that the hand moved while the clutch was held.
/// Positions in one frame, m. Real-time.
class Clutch {
 public:
  /// The tool's position while the hand is at `hand`: `rest`, finite, while the clutch is `held`;
  /// then it moves on from there as the hand does. A hand that is not finite moves nothing, and
  /// the result is not finite.
  [[nodiscard]] Eigen::Vector3d tool(const Eigen::Vector3d& hand, bool held,
                                     const Eigen::Vector3d& rest) noexcept {
    if (!held || !hand.allFinite()) return hand + shift_;
    shift_ = rest - hand;
    return rest;
  }

  /// From the hand to the tool while the clutch is not held, m.
  [[nodiscard]] const Eigen::Vector3d& shift() const noexcept { return shift_; }

 private:
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();
};

}  // namespace palpate
