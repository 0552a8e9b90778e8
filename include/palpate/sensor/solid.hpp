#pragma once

#include <Eigen/Geometry>

#include "palpate/field/analytic.hpp"

namespace palpate {

enum class SolidKind {
  half_space,  ///< all below the local plane z = 0
  ball,        ///< of radius size.x
  block,       ///< half lengths size
  cylinder,    ///< along local z, radius size.x, half height size.z
};

/// A convex solid whose signed distance is known exactly, inside and outside.
struct Solid {
  SolidKind kind = SolidKind::half_space;
  Eigen::Isometry3d T_world_solid = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< m
};

[[nodiscard]] double distance(const Solid& solid, const Eigen::Vector3d& x);

/// With the gradient, which is the outward unit normal, in the world frame. Where it jumps (edges
/// seen from inside, the middle of a ball) one of its limits is taken.
[[nodiscard]] Distance distance_and_normal(const Solid& solid, const Eigen::Vector3d& x);

}  // namespace palpate
