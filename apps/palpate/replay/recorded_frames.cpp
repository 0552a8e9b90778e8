#include "apps/palpate/replay/recorded_frames.hpp"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "apps/palpate/record/options_json.hpp"
#include "apps/palpate/record/recorded_messages.hpp"
#include "message/depth_images.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {

namespace {

Eigen::Isometry3d pose_of_rows(const std::vector<double>& rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = rows.at(static_cast<std::size_t>(i));
  return pose;
}

// Bit for bit, unlike message::read_depth().
void take_depths(const message::Image& image, DepthFrame& frame) {
  frame.depth.resize(image.data.size() / sizeof(float));
  if (frame.depth.empty()) return;
  std::memcpy(frame.depth.data(), image.data.data(), frame.depth.size() * sizeof(float));
}

CameraModel lens_of(const message::CameraInfo& info) {
  CameraModel lens;
  lens.width = static_cast<int>(info.width);
  lens.height = static_cast<int>(info.height);
  lens.pinhole = {info.k[0], info.k[4], info.k[2], info.k[5]};
  if (info.d.size() >= 5) lens.distortion = {info.d[0], info.d[1], info.d[2], info.d[3], info.d[4]};
  return lens;
}

}  // namespace

bag::Attachment attachment_named(const bag::McapReader& reader, const std::string& name) {
  const auto& places = reader.contents().attachments;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].head.name == name) return reader.attachment(i);
  }
  throw Error(
      fmt::format("there is no '{}' in it; give a file that palpate touch --record wrote", name));
}

void show_surface(const bag::McapReader& reader, std::size_t index, const Json& json,
                  Source& source) {
  const bag::Attachment attached = attachment_named(reader, surface_name(index));
  Source prepared(source.name(), source.options());
  if (json.contains("lens")) {
    DepthFrame frame;
    message::Image image;
    message::decode(bag::View(attached.data), image);
    take_exact(json.at("lens"), frame.camera);
    take_exact(json.at("pose"), frame.T_world_sensor);
    take_depths(image, frame);
    prepared.set(frame);
  } else {
    message::Cloud cloud;
    message::decode(bag::View(attached.data), cloud);
    prepared.set(cloud_of(cloud));
  }
  publish_surface(prepared, source);
}

void publish_surface(const Source& prepared, Source& source) {
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back({prepared.points(), 1, 1});
  source.publish(std::move(snapshot));
}

RecordedFrames::RecordedFrames(const std::string& path, const bag::McapReader& reader,
                               const std::string& topic)
    : reader_(path, reader.contents()), topic_(topic + "/") {
  seek(0);
}

void RecordedFrames::seek(std::uint64_t from) {
  reader_.choose([&](const bag::Channel& each) { return each.topic.starts_with(topic_); }, from);
}

std::optional<RecordedFrame> RecordedFrames::next() {
  RecordedFrame recorded;
  DepthFrame& frame = recorded.frame;
  for (bag::Message message; reader_.next(message);) {
    const std::string& type = reader_.channel_of(message).schema.name;
    if (type == message::ros_name(message::CameraInfo::kName)) {
      message::CameraInfo info;
      message::decode(message.data, info);
      frame.camera = lens_of(info);
    } else if (type == message::ros_name(message::Image::kName)) {
      message::Image image;
      message::decode(message.data, image);
      take_depths(image, frame);
    } else if (type == message::ros_name(message::Cloud::kName)) {
      message::Cloud cloud;
      message::decode(message.data, cloud);
      frame.cloud = std::make_shared<PointCloud>(cloud_of(cloud));
    } else if (type == message::ros_name(message::FrameUse::kName)) {
      message::decode(message.data, recorded.use);
      frame.stamp = recorded.use.stamp;
      if (!recorded.use.pose.empty()) frame.T_world_sensor = pose_of_rows(recorded.use.pose);
      return recorded;
    }
  }
  return std::nullopt;
}

}  // namespace palpate::app
