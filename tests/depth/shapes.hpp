#pragma once

#include <Eigen/Geometry>

#include "sim/simulated_depth.hpp"

namespace palpate::test {

/// A half space whose surface holds `point` and looks along `normal`.
inline Solid plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  Solid solid;
  solid.T_world_solid.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  solid.T_world_solid.translation() = point;
  return solid;
}

inline Solid sphere(const Eigen::Vector3d& center, double radius) {
  Solid solid;
  solid.kind = SolidKind::ball;
  solid.T_world_solid.translation() = center;
  solid.size = Eigen::Vector3d::Constant(radius);
  return solid;
}

/// One of whose edges looks at the camera.
inline Solid box(const Eigen::Vector3d& center, double half, double turn, double tilt) {
  Solid solid;
  solid.kind = SolidKind::block;
  solid.T_world_solid.linear() = (Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()))
                                     .toRotationMatrix();
  solid.T_world_solid.translation() = center;
  solid.size = Eigen::Vector3d::Constant(half);
  return solid;
}

}  // namespace palpate::test
