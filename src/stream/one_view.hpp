#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "palpate/field/surface_points.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// Finds the eye of clouds that were seen from one position: a requested one, or the viewpoint of a
/// cloud that proves it.
class OneView {
 public:
  /// The eye of a cloud, if all of it was seen from there and from the sides that its normals will
  /// point to. A cloud with normals proves its viewpoint where they face it; one without where a
  /// camera there sees each point in its pixel, and then it proves that of all that follow it,
  /// since few pixels prove nothing. `T_world_sensor`: of the cloud's frame.
  [[nodiscard]] std::optional<SurfaceEye> eye_of(const PointCloud& cloud,
                                                 const PrepareOptions& options,
                                                 const Eigen::Isometry3d& T_world_sensor);

 private:
  bool proved_ = false;
};

}  // namespace palpate
