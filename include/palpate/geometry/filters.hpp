#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// The points of `cloud` named by `indices`, in that order, with all their columns. Origin and
/// viewpoint are kept.
[[nodiscard]] PointCloud select(const PointCloud& cloud, std::span<const std::uint32_t> indices);

/// The points inside `box`, its faces included (in the cloud's frame, m), in their order.
[[nodiscard]] PointCloud clip(const PointCloud& cloud, const Box& box);

/// 1 for each point, in sorted order, that noise has put where no surface is: fewer than three
/// others within 2 R_i and 2 R_j of each other, or S_i < 0.35 Sbar_i (docs/method.md 5.4; the
/// sums of density_weights(), with Wyvill's kernel). radii: the R_i, m.
/// @throws Error when there are not as many radii as points, or one is not positive and finite.
[[nodiscard]] std::vector<std::uint8_t> speckle_mask(const CellGrid& grid,
                                                     std::span<const float> radii);

/// One point for each occupied cube of side `leaf` (m): the mean of the points in it, of their
/// normals (made unit again; zero where they cancel), colours and intensities. The cubes' corners
/// lie at whole multiples of `leaf` from the cloud's origin, which is kept, as is the viewpoint.
/// Points come in the order of their cubes, z slowest and x fastest. `counts`, where it is asked
/// for: how many points each of them stands for.
/// @throws Error when the leaf is not positive and finite, or so small that the cloud is more than
/// 2^21 cubes long (which is where 32-bit indices of other filters have long overflowed), or when a
/// position is not finite.
[[nodiscard]] PointCloud voxel_downsample(const PointCloud& cloud, double leaf,
                                          std::vector<std::uint32_t>* counts = nullptr);

}  // namespace palpate
