#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "sim/simulated_depth.hpp"

namespace palpate {

/// Pixels beside one another: their rays (x, y, 1) in the camera's frame, and the nearest depth so
/// far.
struct RayRow {
  const double* x = nullptr;
  const double* y = nullptr;
  float* depth = nullptr;
  std::size_t count = 0;
};

/// Lowers the depths of rays that enter the solid nearer than what they have met so far.
void cut_rays(const Solid& solid, const Eigen::Isometry3d& T_solid_camera, const RayRow& rays);

}  // namespace palpate
