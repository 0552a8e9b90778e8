// What a device can hold of a wrench.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "palpate/geometry/pose.hpp"

namespace palpate {

[[nodiscard]] inline bool is_finite(const Wrench& wrench) noexcept {
  return wrench.force.allFinite() && wrench.torque.allFinite() && std::isfinite(wrench.grip);
}

/// The same direction, no longer than `most`. What is as short comes back bit for bit.
[[nodiscard]] inline Eigen::Vector3d shortened(const Eigen::Vector3d& force, double most) noexcept {
  const double length = force.norm();
  return length > most ? Eigen::Vector3d(most / length * force) : force;
}

/// Each part by itself, to these maxima (N, N m, N).
[[nodiscard]] inline Wrench shortened(const Wrench& wrench, double force, double torque,
                                      double grip) noexcept {
  return {shortened(wrench.force, force), shortened(wrench.torque, torque),
          std::clamp(wrench.grip, -grip, grip)};
}

}  // namespace palpate
