// Turns ROS images and clouds into DepthFrames.
#include "sensor/ros_frames.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "io/cloud_builder.hpp"
#include "palpate/base/error.hpp"

namespace palpate::sensor {

void RosFrames::set_camera(const message::CameraInfo& info) {
  try {
    camera_ = camera_of(info, message::is_rectified(topic_));
  } catch (const Error& error) {
    lose_camera(error.what());
  }
}

void RosFrames::lose_camera(std::string why) {
  camera_.reset();
  no_camera_ = std::move(why);
}

void RosFrames::fill_image(const auto& image, DepthFrame& frame) const {
  if (!camera_) throw Error(fmt::format("{}: {}", info_topic_, no_camera_));
  frame.camera = *camera_;
  read_depth(image, frame, unit_);
  if (frame.camera.width != camera_->width || frame.camera.height != camera_->height) {
    throw Error(fmt::format("an image of {} x {} pixels, but {} describes {} x {}",
                            frame.camera.width, frame.camera.height, info_topic_, camera_->width,
                            camera_->height));
  }
}

void RosFrames::fill(const message::Image& image, DepthFrame& frame) const {
  fill_image(image, frame);
}

void RosFrames::fill(const message::CompressedImage& image, DepthFrame& frame) const {
  fill_image(image, frame);
}

void RosFrames::fill(const message::PointCloud2& points, DepthFrame& frame) const {
  frame.depth.clear();
  frame.colors.clear();
  PointCloud cloud = cloud_of(points);
  if (unit_) io::rescale(cloud, *unit_);
  frame.cloud = std::make_shared<const PointCloud>(std::move(cloud));
}

}  // namespace palpate::sensor
