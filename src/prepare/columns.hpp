#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/sheets.hpp"

namespace palpate {

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
void tell_trust(const SurfacePoints& points, PrepareReport& report);

/// The same points in the world frame.
[[nodiscard]] PointCloud placed(PointCloud cloud, const Eigen::Isometry3d& T_world_sensor);

/// Lets points that stand for many weigh more than those that stand for few: multiplies each
/// density weight by the point's count over the mean count within its radius. Sums of weights stay
/// near 1, and means over points become means over what was measured, which halves their noise. All
/// in sorted order; radii in m.
void weigh_by_counts(const CellGrid& grid, std::span<const std::uint32_t> counts,
                     std::span<const float> radii, std::vector<float>& weights);

/// Puts points that lie on two sheets on both, with half their weight each: a sheet that lacks the
/// points of its crease would give way there. Indexes the points again.
void add_twins(std::span<const Twin> twins, SurfacePoints& points);

}  // namespace palpate
