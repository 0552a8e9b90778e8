#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "palpate/geometry/pinhole.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::accuracy {

struct TruthScene;

/// Depth along the optical axis, m, row by row; 0: nothing measured.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<double> depth;

  [[nodiscard]] double& at(int u, int v) { return depth[static_cast<std::size_t>(v * width + u)]; }
  [[nodiscard]] double at(int u, int v) const {
    return depth[static_cast<std::size_t>(v * width + u)];
  }
};

/// The camera of evaluation.md.
struct DepthCamera {
  Pinhole pinhole{525, 525, 319.5, 239.5};
  int width = 640;
  int height = 480;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// The scene's exact depth, within 1 um.
[[nodiscard]] DepthImage render_depth(const TruthScene& scene);

/// Every measured pixel as a point in the camera's frame, whose viewpoint is its origin.
[[nodiscard]] PointCloud back_project(const DepthImage& image, const Pinhole& pinhole);

}  // namespace palpate::accuracy
