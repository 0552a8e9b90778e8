// Motions of a rigid tool or a gripper as vectors whose plain length is that of the metric.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "palpate/geometry/pose.hpp"

namespace palpate {

/// Three of position, three of orientation, one of a gripper's opening.
inline constexpr int kFreedoms = 7;
/// Displacement of the handle, rotation vector times the gyration, change of the opening; all m.
using Motion = Eigen::Matrix<double, kFreedoms, 1>;

/// The orientation after a turn by the rotation vector w (rad, world).
[[nodiscard]] inline Eigen::Quaterniond turned(const Eigen::Quaterniond& orientation,
                                               const Eigen::Vector3d& w) noexcept {
  const double angle = w.norm();
  if (!(angle > 0)) return orientation;
  Eigen::Quaterniond turn;
  turn.w() = std::cos(0.5 * angle);
  turn.vec() = std::sin(0.5 * angle) / angle * w;
  return (turn * orientation).normalized();
}

/// The shortest turn from one orientation to the other, as a rotation vector (rad, world).
[[nodiscard]] inline Eigen::Vector3d turn_between(const Eigen::Quaterniond& from,
                                                  const Eigen::Quaterniond& to) noexcept {
  const Eigen::Quaterniond turn = to * from.conjugate();
  const double sine = turn.vec().norm();  // of half the angle
  constexpr double kSmall = 1e-9;         // rad: sine and angle are the same number there
  const double cosine = std::abs(turn.w());
  const double stretch = sine < kSmall ? 2 : 2 * std::atan2(sine, cosine) / sine;
  return std::copysign(stretch, turn.w()) * turn.vec();
}

/// The metric diag(I, g^2 I, 1) of poses, g the gyration (docs/method.md 3.7).
struct Metric {
  double gyration = 1;  ///< what a radian counts, m

  [[nodiscard]] Motion between(const Pose& from, const Pose& to) const noexcept {
    Motion motion;
    motion << to.position - from.position,
        gyration * turn_between(from.orientation, to.orientation), to.opening - from.opening;
    return motion;
  }
  [[nodiscard]] Eigen::Vector3d rotation(const Motion& motion) const noexcept {
    return motion.segment<3>(3) / gyration;
  }
  [[nodiscard]] Pose moved(const Pose& pose, const Motion& motion) const noexcept {
    return {pose.position + motion.head<3>(), turned(pose.orientation, rotation(motion)),
            pose.opening + motion[6]};
  }
};

}  // namespace palpate
