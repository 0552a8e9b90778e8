// Turns of what has an orientation, as rotation vectors.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace palpate {

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

/// Is it a rotation, up to rounding that normalising mends?
[[nodiscard]] inline bool is_about_unit(const Eigen::Quaterniond& orientation) noexcept {
  constexpr double kNotUnit = 0.1;  // a length is so far from 1 by no rounding
  return std::abs(orientation.norm() - 1) <= kNotUnit;
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

}  // namespace palpate
