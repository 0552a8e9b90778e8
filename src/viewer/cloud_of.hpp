#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "palpate/field/surface_points.hpp"
#include "viewer/cloud_message.hpp"

namespace palpate::viewer {

/// The points that can be felt, where they are going to be, thinned to `budget`, relative to
/// `origin` (m, world). Source and stamp are left to the caller.
[[nodiscard]] CloudMessage cloud_of(const SurfacePoints& points, const Eigen::Vector3d& origin,
                                    std::size_t budget);

}  // namespace palpate::viewer
