#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {

/// @throws Error when the pose is not a rotation and a finite shift.
void check_pose(const Eigen::Isometry3d& pose);

/// @throws Error naming the option that makes no sense, by itself or for this cloud, or what
/// is wrong with the cloud: columns of odd lengths, an origin or a viewpoint that is not finite.
/// Positions are the index's to refuse.
void check(const PrepareOptions& options, const PointCloud& cloud);

/// The share of normals that say something: files mark missing ones by zeros or by no numbers. 0 of
/// none.
[[nodiscard]] double share_given(std::span<const Eigen::Vector3f> given);

/// Replaces fitted normals by the given ones that are within 20 degrees of them, whatever their
/// sign, if given ones vary no more from a point to its nearest than fitted ones do. In sorted
/// order.
void take_given_normals(const CellGrid& grid, std::span<const Eigen::Vector3f> given,
                        std::span<Eigen::Vector3f> normals);

}  // namespace palpate
