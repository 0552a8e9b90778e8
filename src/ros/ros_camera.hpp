#pragma once

#include <memory>
#include <string>

#include "palpate/base/clock.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::ros {

/// Opens "TOPIC[,frame=FRAME]", a topic of depth images (Image of 16UC1 or 32FC1 with the
/// CameraInfo beside it, CompressedImage) or of PointCloud2, whose publisher may appear later. With
/// a frame, images are placed in it by /tf and /tf_static. Stamps of programs whose clock is this
/// machine's are brought to `clock`, others (10 s off) replaced by the time of arrival. The domain
/// is as the environment says (options_from()). Without a clock, the host's is taken.
/// @throws Error when the name is not one, or DDS fails.
[[nodiscard]] std::unique_ptr<DepthCamera> open_ros_camera(const std::string& name,
                                                           const Clock* clock);

}  // namespace palpate::ros
