// A camera of palpate's as a node of ROS 2 would publish it: camera_node CAMERA TOPIC SECONDS
// [cloud|compressed]. Stands for another process in tests, and tells on standard output how many
// frames it sent.
#include <fmt/format.h>

#include <chrono>
#include <string>

#include "dds/endpoint.hpp"
#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace {

using namespace palpate;

PointCloud points_of(const DepthFrame& frame) {
  PointCloud cloud;
  const Pinhole& p = frame.camera.pinhole;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const auto z = static_cast<double>(frame.depth[i]);
    const auto width = static_cast<std::size_t>(frame.camera.width);
    if (z <= 0) continue;
    cloud.positions.emplace_back(Eigen::Vector3d((static_cast<double>(i % width) - p.cx) * z / p.fx,
                                                 (static_cast<double>(i / width) - p.cy) * z / p.fy,
                                                 z)
                                     .cast<float>());
  }
  return cloud;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) return 2;
  const std::string topic = arguments[2];
  const bool as_cloud = count > 4 && std::string(arguments[4]) == "cloud";
  SteadyClock clock;
  const auto camera = open_camera(arguments[1], {.clock = &clock});
  const dds::Participant participant(dds::environment_options());
  dds::Writer<message::Image> images(participant, as_cloud ? "/unused" : topic, {.depth = 2});
  dds::Writer<message::PointCloud2> clouds(participant, as_cloud ? topic : "/unused_cloud",
                                           {.depth = 2});
  dds::Writer<message::CameraInfo> infos(participant, message::info_topic(topic), {.depth = 2});
  dds::Writer<message::TFMessage> frames(participant, "/tf", {.reliable = true, .depth = 100});
  DepthFrame frame;
  std::uint64_t sent = 0;
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
    if (as_cloud) {
      message::PointCloud2 cloud = message::message_of(points_of(frame));
      cloud.header = header;
      clouds.write(cloud);
    } else {
      message::Image image = message::image_of(frame);
      image.header = header;
      images.write(image);
    }
    ++sent;
  }
  fmt::print("sent {}\n", sent);
}
