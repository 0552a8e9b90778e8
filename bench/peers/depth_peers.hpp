#pragma once

#include <cstddef>

#include "palpate/depth/depth_frame.hpp"

namespace palpate::bench {

/// What others need to make a depth frame touchable: points, normals and an index over them, and
/// the mean distance to the three nearest others, on one thread. Returns the number of points, 0
/// in builds without PCL.

/// Back-projection, VoxelGrid with this leaf (m), KdTreeFLANN, NormalEstimation within 2.5 s, s the
/// leaf, and the k = 3 spacing.
[[nodiscard]] std::size_t pcl_pipeline(const DepthFrame& frame, float leaf);

/// Back-projection, IntegralImageNormalEstimation (AVERAGE_3D_GRADIENT), VoxelGrid over points with
/// normals, KdTreeFLANN and the k = 3 spacing.
[[nodiscard]] std::size_t pcl_organised_pipeline(const DepthFrame& frame, float leaf);

}  // namespace palpate::bench
