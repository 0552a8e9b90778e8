// The second step of prepare(): the points that are kept, how far apart and how noisy they are.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/elements_at.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/noise.hpp"
#include "prepare/place.hpp"

namespace palpate {

/// The points that are kept. Columns are in sorted order.
struct Sampling {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the grid, world frame, m
  CellGrid grid;
  std::vector<float> spacings;           ///< s of each point, m
  LocalNoise local;                      ///< without products: the same everywhere
  std::vector<std::uint32_t> counts;     ///< raw points that each stands for; empty: one each
  std::vector<Eigen::Vector3f> normals;  ///< that were given; empty: none
  std::vector<float> intensities;        ///< empty: not requested
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< empty: none

  CloudFacts facts;    ///< of the raw points: given, or measured of these
  double spacing = 0;  ///< s of those that are kept: a median, or the paper's, m
  double voxel = 0;    ///< leaf of the filter, m; 0: none
};

/// The leaf of the voxel filter for a cloud with these facts, m; 0: none.
[[nodiscard]] double voxel_of(const CloudFacts& facts, const PrepareOptions& options);

/// Indices of the first point at each position, in input order.
[[nodiscard]] std::vector<std::uint32_t> distinct_points(const CellGrid& grid);

/// Indexes the cloud, drops points at positions of others, measures spacing and noise, and thins
/// noisy clouds. Writes what it finds and how long it takes into the `report`.
[[nodiscard]] Sampling sample(const Placed& placed, const PrepareOptions& options,
                              Prepared::Report& report);

/// A cloud's column in the order of the grid made of it; empty if it is.
template <class T>
[[nodiscard]] std::vector<T> in_grid_order(const CellGrid& grid, const std::vector<T>& column) {
  return detail::elements_at(column, grid.order());
}

}  // namespace palpate
