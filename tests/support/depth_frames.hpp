#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::test {

/// A small camera whose blocks are 2.7 mm apart on a surface 0.5 m away.
inline CameraModel small_camera() {
  return {160, 120, {375, 375, 79.5, 59.5}, {}};
}

/// Depth along the optical axis for a ray (x, y, 1) of the sensor's frame, m; 0: nothing.
using DepthOf = std::function<double(double x, double y)>;

/// What a camera sees. `noise`: standard deviation of each pixel, m.
inline DepthFrame frame_of(const CameraModel& camera, double stamp, const DepthOf& depth_of,
                           double noise = 0, unsigned seed = 1) {
  DepthFrame frame;
  frame.camera = camera;
  frame.stamp = stamp;
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss{0, 1};
  const Pinhole& p = camera.pinhole;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z = depth_of((u - p.cx) / p.fx, (v - p.cy) / p.fy);
      const double error = noise > 0 ? noise * gauss(random) : 0;
      frame.depth.push_back(z > 0 ? static_cast<float>(z + error) : 0.0f);
    }
  }
  return frame;
}

/// The plane through `point` with normal `normal`, sensor frame.
inline DepthOf plane_depth(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  return [=](double x, double y) {
    const double along = normal.dot(Eigen::Vector3d(x, y, 1));
    return std::abs(along) > 1e-9 ? normal.dot(point) / along : 0;
  };
}

/// A plane that faces the sensor at depth z.
inline DepthOf wall(double z) {
  return plane_depth({0, 0, z}, -Eigen::Vector3d::UnitZ());
}

/// A sensor at z = 0.5 m that looks straight down at the origin: heights are 0.5 m less depth.
inline Eigen::Isometry3d looking_down() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(0, 0, 0.5));
  T.rotate(Eigen::AngleAxisd(3.14159265358979323846, Eigen::Vector3d::UnitX()));
  return T;
}

}  // namespace palpate::test
