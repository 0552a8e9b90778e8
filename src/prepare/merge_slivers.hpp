#pragma once

#include <cstdint>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

/// Joins points that stand for few with those for many within `distance` (m) of them, weighted by
/// how many each stands for: `counts`, which become those of the result.
///
/// Where a noisy surface runs along a face of the voxels, half of its points are averaged above it
/// and half below: pairs of centroids that lie off the surface, and off it on one side where the
/// voxels hold unequal shares. Joined they lie on it. The result keeps the order of those that
/// others were joined to.
[[nodiscard]] PointCloud merge_slivers(const PointCloud& cloud, double distance,
                                       std::vector<std::uint32_t>& counts);

}  // namespace palpate
