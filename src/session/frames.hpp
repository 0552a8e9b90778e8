#pragma once

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/scene/source.hpp"
#include "palpate/viewer/viewer.hpp"

namespace palpate::session {

/// Makes what `prepared` shows the surface of `source`, for good.
void publish_surface(const Source& prepared, Source& source);

/// The points of a frame's pixels in the camera's frame, as a driver would hand them to the paper's
/// program. The lens is taken to be without distortion. @throws Error when there is not one depth a
/// pixel, or no pixel.
[[nodiscard]] PointCloud cloud_of(const DepthFrame& frame);

/// What a camera sees, as drawn: half as far again as what it looks at, in the median `depth` m
/// away.
[[nodiscard]] inline ViewerOptions::Stream::Frustum frustum_of(const CameraModel& camera,
                                                               double depth) {
  return {0.5 * camera.width / camera.pinhole.fx, 0.5 * camera.height / camera.pinhole.fy,
          1.5 * depth};
}

}  // namespace palpate::session
