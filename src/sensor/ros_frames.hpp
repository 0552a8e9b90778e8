#pragma once

#include <optional>
#include <string>

#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "palpate/depth/depth_frame.hpp"

namespace palpate::sensor {

/// Makes frames of the messages of one topic and of the CameraInfo beside it, wherever they come
/// from: a topic that is there now, or a recording. One thread at a time.
class RosFrames {
 public:
  /// `unit`: metres a step of depths and coordinates; none: as the messages' type defines.
  explicit RosFrames(std::string topic, std::optional<double> unit = {})
      : topic_(std::move(topic)), info_topic_(message::info_topic(topic_)), unit_(unit) {}

  [[nodiscard]] const std::string& topic() const { return topic_; }
  [[nodiscard]] const std::string& info_topic() const { return info_topic_; }

  /// Sets the camera of the images from now on. fill() throws if it cannot be used.
  void set_camera(const message::CameraInfo& info);
  /// There is no camera, for this reason.
  void lose_camera(std::string why);

  /// Fills camera and depths, or the cloud of a sensor that delivers points. Stamp and pose stay
  /// for the caller to set.
  /// @throws Error that states why that cannot be.
  void fill(const message::Image& image, DepthFrame& frame) const;
  void fill(const message::CompressedImage& image, DepthFrame& frame) const;
  void fill(const message::PointCloud2& points, DepthFrame& frame) const;

 private:
  void fill_image(const auto& image, DepthFrame& frame) const;

  std::string topic_;
  std::string info_topic_;
  std::optional<double> unit_;
  std::optional<CameraModel> camera_;
  std::string no_camera_ = "no CameraInfo has come yet";
};

}  // namespace palpate::sensor
