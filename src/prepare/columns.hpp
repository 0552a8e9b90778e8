#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/sheets.hpp"

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

/// A cloud's column in the order of the grid made of it.
template <class T>
[[nodiscard]] std::vector<T> in_grid_order(const CellGrid& grid, const std::vector<T>& column) {
  std::vector<T> sorted;
  sorted.reserve(column.size());
  for (const std::uint32_t i : grid.order()) sorted.push_back(column[i]);
  return sorted;
}

/// Of points at one place, which tell no more than one of them, the first; in the order that the
/// grid was given them.
[[nodiscard]] std::vector<std::uint32_t> first_of_each_place(const CellGrid& grid);

/// In grid order; 0 at the lowest, 1 at the highest intensity.
[[nodiscard]] std::vector<float> materials_of(const CellGrid& grid,
                                              const std::vector<float>& intensities);

/// How far the normals of what is felt are trusted.
void tell_trust(const SurfacePoints& points, Prepared::Report& report);

/// The same points in the world frame.
[[nodiscard]] PointCloud placed(PointCloud cloud, const Eigen::Isometry3d& T_world_sensor);

/// Puts points that lie on two sheets on both, with half their weight each: a sheet that lacks the
/// points of its crease would give way there. Indexes the points again.
void add_twins(std::span<const Twin> twins, SurfacePoints& points);

}  // namespace palpate
