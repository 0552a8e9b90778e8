#pragma once

#include "palpate/depth/depth_filter.hpp"

namespace palpate::depth {

/// @throws Error when an option is out of range.
void check(const DepthFilterOptions& options);

/// @throws Error when the frame's size and depths disagree or its camera is none.
void check(const DepthFrame& frame);

/// @throws Error when the pose is not finite.
void check(const Eigen::Isometry3d& T_world_sensor);

}  // namespace palpate::depth
