// Declares scenes of convex solids with exact distances, and their rendering.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/field/analytic.hpp"

namespace palpate {

using Distance = AnalyticField::Distance;

enum class SolidKind {
  half_space,  ///< all below the local plane z = 0
  ball,        ///< of radius size.x
  block,       ///< half lengths size
  cylinder,    ///< along local z, radius size.x, half height size.z
};

/// A convex solid whose signed distance is exact, inside and outside.
struct Solid {
  SolidKind kind = SolidKind::half_space;
  Eigen::Isometry3d T_world_solid = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< m
};

[[nodiscard]] double distance(const Solid& solid, const Eigen::Vector3d& x);

/// Distance and its gradient, the outward unit normal, in the world frame. Where the gradient jumps
/// (edges seen from inside, the middle of a ball) it is one of its limits.
[[nodiscard]] Distance distance_and_normal(const Solid& solid, const Eigen::Vector3d& x);

/// Renders solids as a perfect depth camera sees them: rays are cut with them in closed form.
/// Several threads may use one object.
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
