#pragma once

#include <optional>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "sim/simulated_depth.hpp"

namespace palpate::test {

/// A ball on a slanted floor with a step beside it, as a camera of odd numbers sees them; nothing
/// is measured where the floor is too far away, nor in a square.
inline DepthFrame organised_frame() {
  const CameraModel camera{160, 120, {151.5, 149.25, 81.25, 57.5}, {}};
  Solid floor;
  floor.T_world_solid.translate(Eigen::Vector3d(0, 0, 0.9));
  floor.T_world_solid.rotate(Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitX()));
  Solid ball{SolidKind::ball, Eigen::Isometry3d::Identity(), {0.1, 0, 0}};
  ball.T_world_solid.translate(Eigen::Vector3d(0.05, 0, 0.8));
  Solid block{SolidKind::block, floor.T_world_solid, {0.1, 0.1, 0.05}};
  block.T_world_solid.translate(Eigen::Vector3d(-0.2, 0.1, 0));
  DepthFrame frame;
  frame.camera = camera;
  const std::vector<Solid> solids{floor, ball, block};
  DepthRenderer(camera, 1.1).render(solids, Eigen::Isometry3d::Identity(), frame.depth);
  for (int v = 20; v < 30; ++v) {
    for (int u = 90; u < 100; ++u) frame.depth[static_cast<std::size_t>(v * 160 + u)] = 0;
  }
  return frame;
}

/// The points of its pixels, and which they were. `T_cloud_camera` puts them elsewhere and says so
/// by the viewpoint; without it there is none.
inline PointCloud organised_cloud(const DepthFrame& frame,
                                  const std::optional<Eigen::Isometry3d>& T_cloud_camera = {}) {
  const Pinhole& p = frame.camera.pinhole;
  PointCloud cloud;
  cloud.width = static_cast<std::size_t>(frame.camera.width);
  cloud.height = static_cast<std::size_t>(frame.camera.height);
  const Eigen::Isometry3d T = T_cloud_camera.value_or(Eigen::Isometry3d::Identity());
  if (T_cloud_camera) cloud.viewpoint = T.translation();
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const double z = static_cast<double>(frame.depth[i]);
    if (z <= 0) continue;
    const double x = (static_cast<double>(i % cloud.width) - p.cx) * z / p.fx;
    const double y = (static_cast<double>(i / cloud.width) - p.cy) * z / p.fy;
    cloud.positions.push_back((T * Eigen::Vector3d(x, y, z)).cast<float>());
    cloud.pixels.push_back(static_cast<std::uint32_t>(i));
  }
  return cloud;
}

}  // namespace palpate::test
