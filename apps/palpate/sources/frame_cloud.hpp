#pragma once

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::app {

/// The points of a frame's pixels in the camera's frame, as a driver would hand them to the paper's
/// program. The lens is taken to be without distortion.
[[nodiscard]] PointCloud cloud_of(const DepthFrame& frame);

}  // namespace palpate::app
