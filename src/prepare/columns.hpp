#pragma once

#include <cstdint>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "palpate/prepare/prepare.hpp"

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

}  // namespace palpate
