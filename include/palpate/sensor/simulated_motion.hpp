#pragma once

#include <Eigen/Geometry>
#include <limits>

namespace palpate {

/// How a solid or a camera moves: a straight line and a turn between two times, and a sine of
/// either, all added up. Turns are about the body's own origin.
struct SimulatedMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();       ///< m/s, from `begin` to `end`
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();          ///< of turns, world frame, unit
  double spin = 0;                                          ///< rad/s, from `begin` to `end`
  double begin = -std::numeric_limits<double>::infinity();  ///< s; before it, as at it
  double end = std::numeric_limits<double>::infinity();     ///< s; after it, as at it
  Eigen::Vector3d swing = Eigen::Vector3d::Zero();          ///< amplitude of a sine, m
  double rock = 0;                                          ///< amplitude of a sine turn, rad
  double frequency = 0;                                     ///< of both sines, Hz
  double phase = 0;                                         ///< of both sines, rad
};

/// Where a body that is at `pose` when nothing of its motion has happened is at time t (s). The
/// straight line and the turn count from t = 0, or from `begin` where that is finite.
[[nodiscard]] Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const SimulatedMotion& motion,
                                      double t);

/// How fast that body moves at time t where x is, m/s, world.
[[nodiscard]] Eigen::Vector3d velocity(const Eigen::Isometry3d& pose, const SimulatedMotion& motion,
                                       const Eigen::Vector3d& x, double t);

}  // namespace palpate
