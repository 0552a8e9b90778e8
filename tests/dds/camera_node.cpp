// A camera of palpate's as a node of ROS 2 would publish it: camera_node CAMERA TOPIC SECONDS
// [32FC1|16UC1|compressed|cloud]. Stands for another process in tests, and tells on standard output
// how many frames it sent, and how many while somebody listened.
#include <fmt/format.h>
#include <spng.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

#include "dds/endpoint.hpp"
#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace {

using namespace palpate;

message::PointCloud2 cloud_of(const DepthFrame& frame) {
  PointCloud cloud;
  const Pinhole& p = frame.camera.pinhole;
  const auto width = static_cast<std::size_t>(frame.camera.width);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const auto z = static_cast<double>(frame.depth[i]);
    if (z <= 0) continue;
    cloud.positions.emplace_back(Eigen::Vector3d((static_cast<double>(i % width) - p.cx) * z / p.fx,
                                                 (static_cast<double>(i / width) - p.cy) * z / p.fy,
                                                 z)
                                     .cast<float>());
  }
  return message::message_of(cloud);
}

std::vector<std::uint16_t> millimetres(const DepthFrame& frame) {
  std::vector<std::uint16_t> values;
  for (const float z : frame.depth) values.push_back(static_cast<std::uint16_t>(1e3F * z + 0.5F));
  return values;
}

message::Image image16_of(const DepthFrame& frame) {
  message::Image image = message::image_of(frame);
  const std::vector<std::uint16_t> values = millimetres(frame);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  image.encoding = "16UC1";
  image.step = 2 * image.width;
  image.data.assign(bytes, bytes + 2 * values.size());
  return image;
}

message::CompressedImage compressed(const DepthFrame& frame) {
  const std::vector<std::uint16_t> values = millimetres(frame);
  const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> png(spng_ctx_new(SPNG_CTX_ENCODER),
                                                           &spng_ctx_free);
  spng_set_option(png.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_set_option(png.get(), SPNG_IMG_COMPRESSION_LEVEL, 1);
  spng_ihdr head{.width = static_cast<std::uint32_t>(frame.camera.width),
                 .height = static_cast<std::uint32_t>(frame.camera.height),
                 .bit_depth = 16,
                 .color_type = SPNG_COLOR_TYPE_GRAYSCALE,
                 .compression_method = 0,
                 .filter_method = 0,
                 .interlace_method = 0};
  spng_set_ihdr(png.get(), &head);
  spng_encode_image(png.get(), values.data(), 2 * values.size(), SPNG_FMT_PNG,
                    SPNG_ENCODE_FINALIZE);
  std::size_t size = 0;
  int wrong = 0;
  const std::unique_ptr<void, void (*)(void*)> bytes(spng_get_png_buffer(png.get(), &size, &wrong),
                                                     &std::free);
  const auto* first = static_cast<const std::uint8_t*>(bytes.get());
  message::CompressedImage image;
  image.format = "16UC1; compressedDepth png";
  image.data.assign(12, 0);  // image_transport's head, which only 32FC1 needs
  image.data.insert(image.data.end(), first, first + size);
  return image;
}

/// Writes a frame; false: nobody listens.
using Send = std::function<bool(const DepthFrame&, const message::Header&)>;

template <class T>
Send sender(const dds::Participant& participant, const std::string& topic,
            T (*make)(const DepthFrame&)) {
  const auto writer =
      std::make_shared<dds::Writer<T>>(participant, topic, dds::Quality{.depth = 2});
  return [=](const DepthFrame& frame, const message::Header& header) {
    const bool heard = writer->readers() > 0;
    T told = make(frame);
    told.header = header;
    writer->write(told);
    return heard;
  };
}

Send sender(const dds::Participant& participant, const std::string& topic,
            const std::string& kind) {
  if (kind == "cloud") return sender(participant, topic, cloud_of);
  if (kind == "compressed") return sender(participant, topic, compressed);
  if (kind == "16UC1") return sender(participant, topic, image16_of);
  return sender(participant, topic, message::image_of);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) return 2;
  const std::string topic = arguments[2];
  SteadyClock clock;
  const auto camera = open_camera(arguments[1], {.clock = &clock});
  const dds::Participant participant(dds::environment_options());
  const Send send = sender(participant, topic, count > 4 ? arguments[4] : "32FC1");
  dds::Writer<message::CameraInfo> infos(participant, message::info_topic(topic), {.depth = 2});
  dds::Writer<message::TFMessage> frames(participant, "/tf", {.reliable = true, .depth = 100});
  DepthFrame frame;
  std::uint64_t sent = 0;
  std::uint64_t heard = 0;
  const double end = clock.now() + std::stod(arguments[3]);
  for (camera->begin(clock.now()); clock.now() < end;) {
    const DepthCamera::Status status = camera->read(frame, 0.1);
    if (status == DepthCamera::Status::ended) break;
    if (status != DepthCamera::Status::frame) continue;
    const message::Header header{
        message::to_time(message::system_now() - (clock.now() - frame.stamp)), "camera_depth"};
    const Eigen::Isometry3d pose = frame.T_world_sensor.value_or(Eigen::Isometry3d::Identity());
    frames.write({{{{header.stamp, "world"}, "camera_depth", message::transform_of(pose)}}});
    message::CameraInfo info = message::info_of(frame.camera);
    info.header = header;
    infos.write(info);
    heard += send(frame, header) ? 1 : 0;
    ++sent;
  }
  fmt::print("sent {} heard {}\n", sent, heard);
}
