#pragma once

#include "support/point_shapes.hpp"

namespace palpate::test {

/// Exact points and normals, as a good depth filter gives them.
inline Sampling fine(double radius = 8e-3) {
  return {.spacing = 2e-3, .radius = radius};
}

/// The place whose z axis is `normal`, at `origin`.
inline Eigen::Isometry3d facing(const Eigen::Vector3d& normal, const Eigen::Vector3d& origin) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
  T.translation() = origin;
  return T;
}

/// A convex edge of 90 degrees along the y axis: solid for x < 0 and z < 0. Its first rows of
/// points lie half a spacing from the edge.
inline std::vector<TestPoint> ridge(const Sampling& sampling, double half) {
  const double first = 0.5 * sampling.spacing;
  std::vector<TestPoint> points = sheet(sampling, {-half - first, -half}, {-first, half});
  for (TestPoint p : sheet(sampling, {-half - first, -half}, {-first, half})) {
    std::swap(p.position.x(), p.position.z());
    std::swap(p.normal.x(), p.normal.z());
    points.push_back(p);
  }
  return points;
}

/// A box around the origin of the given half sizes, multiples of the spacing, m.
inline std::vector<TestPoint> box(const Sampling& sampling, const Eigen::Vector3d& half) {
  std::vector<TestPoint> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d normal = sign * Eigen::Vector3d::Unit(axis);
      const Eigen::Isometry3d T = facing(normal, half[axis] * normal);
      const Eigen::Vector3d extent = (T.linear().transpose() * half).cwiseAbs();
      const Eigen::Vector2d inner = extent.head<2>().array() - 0.5 * sampling.spacing;
      const auto face = sheet(sampling, -inner, inner, T);
      points.insert(points.end(), face.begin(), face.end());
    }
  }
  return points;
}

}  // namespace palpate::test
