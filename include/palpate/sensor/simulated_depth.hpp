#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "palpate/depth/camera_model.hpp"
#include "palpate/sensor/solid.hpp"

namespace palpate {

/// What a perfect depth camera sees of solids: rays are cut with them in closed form. One object
/// may be used by several threads.
class DepthRenderer {
 public:
  /// @throws Error when the camera has no pixels, no focal length, or a distortion that cannot be
  /// undone.
  explicit DepthRenderer(const CameraModel& camera, double farthest = 10);

  /// Depths along the optical axis (m, row by row, reusing memory); 0 where nothing is hit within
  /// `farthest`. A solid that the camera is inside of is not seen.
  void render(std::span<const Solid> solids, const Eigen::Isometry3d& T_world_camera,
              std::vector<float>& depth) const;

  [[nodiscard]] const CameraModel& camera() const { return camera_; }

 private:
  CameraModel camera_;
  double farthest_;
  std::vector<double> x_;  // rays (x, y, 1), one a pixel
  std::vector<double> y_;
};

}  // namespace palpate
