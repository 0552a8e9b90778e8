// Records what a camera and its surroundings publish into a bag.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "bag/bags.hpp"
#include "message/depth_images.hpp"
#include "message/transforms.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/depth_camera.hpp"
#include "sensor/fake_camera.hpp"
#include "support/folder.hpp"

namespace palpate::sensor {

using bag::kNoon;
using bag::kSecond;
using bag::McapWriter;

inline constexpr std::uint64_t kMillisecond = kSecond / 1000;

inline message::Header header_at(std::uint64_t time) {
  return {{static_cast<std::int32_t>(time / kSecond), static_cast<std::uint32_t>(time % kSecond)},
          "camera"};
}

// Writes what a camera and its surroundings publish. Times are ns since noon.
struct BagRecorder {
  explicit BagRecorder(const std::string& path) : writer(path) {}

  template <class T>
  void put(std::uint16_t topic, const T& message, std::uint64_t log) {
    writer.write(topic, {kNoon + log, kNoon + log}, message);
  }
  // An image whose depths are `metres` everywhere.
  void image(std::uint64_t log, float metres, std::uint64_t stamp) {
    message::Image image = message::image_of(frame_at(0, metres));
    image.header = header_at(kNoon + stamp);
    put(images, image, log);
  }
  void image(std::uint64_t log, float metres) { image(log, metres, log); }
  void info(std::uint64_t log, const std::string& model = "plumb_bob") {
    message::CameraInfo info = message::info_of(frame_at(0).camera);
    info.distortion_model = model;
    if (model != "plumb_bob") info.d = {0.1, 0, 0, 0};
    put(infos, info, log);
  }
  void transform(std::uint16_t topic, std::uint64_t log, std::uint64_t stamp, const char* parent,
                 const char* child, double x) {
    put(topic,
        message::TFMessage{{{{header_at(kNoon + stamp).stamp, parent}, child, {{x, 0, 0}, {}}}}},
        log);
  }

  McapWriter writer;
  std::uint16_t images = writer.add_topic<message::Image>("/cam/image");
  std::uint16_t infos = writer.add_topic<message::CameraInfo>("/cam/camera_info");
  std::uint16_t tf = writer.add_topic<message::TFMessage>("/tf");
  std::uint16_t still = writer.add_topic<message::TFMessage>("/tf_static");
};

class BagCamera : public testing::Test {
 protected:
  // `count` images at 10 Hz, 1, 2, ... m deep.
  void record(int count) const {
    BagRecorder recorder(path_);
    for (int i = 0; i < count; ++i) {
      recorder.image(static_cast<std::uint64_t>(i) * 100 * kMillisecond, 1 + static_cast<float>(i));
      recorder.info(static_cast<std::uint64_t>(i) * 100 * kMillisecond + 5 * kMillisecond);
    }
  }

  [[nodiscard]] std::string refusal(const std::string& name) const {
    try {
      (void)open_camera(name);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  test::Folder folder_;
  std::string path_ = folder_ / "run.mcap";
  std::string name_ = "bag:" + path_;
};

}  // namespace palpate::sensor
