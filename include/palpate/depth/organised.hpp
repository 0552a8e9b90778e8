#pragma once

#include <optional>
#include <string>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

/// The image that an organised cloud was made of.
struct OrganisedFrame {
  /// Its stamp is 0, its T_world_sensor the camera's pose in the cloud's frame; unset where that is
  /// the cloud's frame itself. Unset as a whole: no pinhole camera sees the points in these pixels.
  std::optional<DepthFrame> frame;
  double residual = 0;   ///< rms distance of points from the middles of their pixels, pixels
  std::string why_none;  ///< why there is no frame, in words
};

/// Finds the camera, and which way it looked, from the points themselves: a pinhole sees each in
/// its pixel. It has to have stood at the cloud's viewpoint or origin. Points that were moved,
/// where they are no more than a hundredth, are left out. Any thread; some 50 ms for 640 x 480.
[[nodiscard]] OrganisedFrame depth_frame_of(const PointCloud& cloud);

}  // namespace palpate
