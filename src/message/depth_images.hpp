#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "message/sensor_types.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate::message {

/// The camera that took images of a topic. `rectified`: its lens was made perfect in them, so that
/// P holds and not K and D. A rational_polynomial lens becomes the CameraModel that comes nearest
/// to it over the image.
/// @throws Error that names what about it cannot be used: another distortion (equidistant), no
///   focal length, a lens that is a pixel or more off.
[[nodiscard]] CameraModel camera_of(const CameraInfo& info, bool rectified);

/// Is it a topic of rectified images by ROS's convention: "rect" in the last part of its name?
[[nodiscard]] bool is_rectified(const std::string& topic);

/// The topic of the CameraInfo beside a topic of images: its last part becomes "camera_info"; of
/// compressed images
/// ("…/image_raw/compressedDepth") the last two.
[[nodiscard]] std::string info_topic(const std::string& image_topic);

/// Puts the depths of an image, 16UC1 (mm) or 32FC1 (m), into `frame.depth` and its size into
/// `frame.camera`. Stamp, pose and the rest of the camera stay as they are. `unit`: the metres a
/// step, where it is another one.
/// @throws Error when it holds no such depths.
void read_depth(const Image& image, DepthFrame& frame, std::optional<double> unit = {});

/// The same of image_transport's "compressedDepth", or of a 16-bit PNG.
void read_depth(const CompressedImage& image, DepthFrame& frame, std::optional<double> unit = {});

/// `frame` as an image of 32FC1, and its camera; stamps and frames of reference stay for the caller
/// to set.
[[nodiscard]] Image image_of(const DepthFrame& frame);
[[nodiscard]] CameraInfo info_of(const CameraModel& camera);

}  // namespace palpate::message
