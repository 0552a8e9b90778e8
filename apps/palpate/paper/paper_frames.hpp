#pragma once

#include <memory>
#include <string>

#include "palpate/depth/depth_frame.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::app {

/// What the paper's figures are made of unless another source is named: a table seen from 0.7 m,
/// 27 degrees from above, with the noise of a Kinect.
inline constexpr const char* kPaperSource = "camera:simulated:still";

/// Opens a camera or sequence, to be read as fast as it goes.
/// @throws Error as opening does, UsageError when `source` is no camera.
[[nodiscard]] std::unique_ptr<DepthCamera> open_paper_source(const std::string& source);

/// Median depth of the pixels in the middle of the image, m. @throws Error when there is none.
[[nodiscard]] double depth_in_the_middle(const DepthFrame& frame);

}  // namespace palpate::app
