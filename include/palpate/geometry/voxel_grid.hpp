#pragma once

#include <cstdint>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

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
