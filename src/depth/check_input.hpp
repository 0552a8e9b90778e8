#pragma once

#include "palpate/depth/depth_filter.hpp"

namespace palpate::depth {

/// @throws Error when an option is out of range.
void check(const DepthFilterOptions& options);

/// Pixels across and down of three blocks: fewer tell no slope.
inline constexpr int kFewestPixels = 6;

/// @throws Error when the frame's size and depths disagree, its camera is none, or it is too small.
void check(const DepthFrame& frame);

/// @throws Error when the pose is not finite.
void check(const Eigen::Isometry3d& T_world_sensor);

}  // namespace palpate::depth
