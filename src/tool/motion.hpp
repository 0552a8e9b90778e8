// Motions of a rigid tool or a gripper as vectors whose plain length is that of the metric.
#pragma once

#include <Eigen/Geometry>

#include "geometry/turn.hpp"
#include "palpate/geometry/pose.hpp"

namespace palpate {

/// Three of position, three of orientation, one of a gripper's opening.
inline constexpr int kFreedoms = 7;
/// Displacement of the handle, rotation vector times the gyration, change of the opening; all m.
using Motion = Eigen::Matrix<double, kFreedoms, 1>;

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
