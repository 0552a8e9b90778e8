#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

#include "palpate/depth/depth_frame.hpp"

/// Where drawn cameras stand, and what they do not see: for benches whose scenes come from a seed.
namespace palpate::bench {

/// The pose of a camera that looks from there at something; its picture's x is level to `up`.
[[nodiscard]] inline Eigen::Isometry3d looking(const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& at,
                                               const Eigen::Vector3d& up) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z = (at - from).normalized();
  const Eigen::Vector3d x = z.cross(up).normalized();
  pose.linear().col(0) = x;
  pose.linear().col(1) = z.cross(x);
  pose.linear().col(2) = z;
  pose.translation() = from;
  return pose;
}

/// Nothing is measured in a disc of `radius` (m) around a place of the sensor's frame.
inline void punch_hole(const Eigen::Vector3d& seen, double radius, DepthFrame& frame) {
  const Pinhole& p = frame.camera.pinhole;
  const double u = p.cx + p.fx * seen.x() / seen.z();
  const double v = p.cy + p.fy * seen.y() / seen.z();
  const double pixels = radius * p.fx / seen.z();
  for (int row = 0; row < frame.camera.height; ++row) {
    for (int column = 0; column < frame.camera.width; ++column) {
      if (std::hypot(column - u, row - v) > pixels) continue;
      frame.depth[static_cast<std::size_t>(row) * frame.camera.width + column] = 0;
    }
  }
}

}  // namespace palpate::bench
