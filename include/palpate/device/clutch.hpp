#pragma once

#include <Eigen/Core>

namespace palpate {

/// Lets a hand move without its tool. Where a device's reach ends the clutch is held, the hand goes
/// back, and the tool goes on from where it rests: further than any device reaches.
///
/// The tool is where the hand is, moved by all ways that the hand went with the clutch held. Pure
/// arithmetic on places in one frame, m. Real-time.
class Clutch {
 public:
  /// Where the tool is while the hand is at `hand`: at `rest`, finite, while the clutch is `held`;
  /// then it goes on from there as the hand does. A hand that is not finite moves nothing, and
  /// gives a tool that is not finite.
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
