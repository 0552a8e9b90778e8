#pragma once

#include <Eigen/Geometry>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// @throws Error when the pose is not a rotation and a finite shift.
void check_pose(const Eigen::Isometry3d& pose);

/// @throws Error naming the option that makes no sense, by itself or for this cloud, or what
/// is wrong with the cloud: columns of odd lengths, an origin or a viewpoint that is not finite.
/// Positions are the index's to refuse.
void check(const PrepareOptions& options, const PointCloud& cloud);

}  // namespace palpate
