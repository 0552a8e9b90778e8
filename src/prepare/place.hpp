// The first step of prepare(): a cloud that is checked, cut and in the world frame.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// A cloud in the world frame. Refers to the one that was given, unless that had to change.
struct Placed {
  const PointCloud& given;
  std::optional<PointCloud> moved;           ///< clipped or turned
  std::optional<Eigen::Vector3d> viewpoint;  ///< of the sensor, world frame, m

  [[nodiscard]] const PointCloud& cloud() const { return moved ? *moved : given; }
};

/// @throws Error naming the option that makes no sense, by itself or for this cloud, or what is
/// wrong with the cloud or the pose, or when no point is left. CellGrid checks the positions.
[[nodiscard]] Placed place(const PointCloud& cloud, const PrepareOptions& options,
                           const Eigen::Isometry3d& T_world_sensor);

/// @throws Error when the pose is not a rotation and a finite shift.
void check_pose(const Eigen::Isometry3d& pose);

}  // namespace palpate
