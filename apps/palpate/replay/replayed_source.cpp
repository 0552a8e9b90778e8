#include "apps/palpate/replay/replayed_source.hpp"

#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "apps/palpate/record/options_json.hpp"
#include "apps/palpate/record/recording_file.hpp"
#include "message/depth_images.hpp"
#include "palpate/base/error.hpp"
#include "scene/source_trace.hpp"

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

// The surface of a source that stood still, as it was prepared before the run.
void show_surface(const bag::McapReader& reader, std::size_t index, const Json& json,
                  const SourceOptions& options, Source& source) {
  const bag::Attachment attached = attachment_named(reader, surface_name(index));
  Source prepared(source.name(), options);
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
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back({prepared.points(), 1, 1});
  source.publish(std::move(snapshot));
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

ReplayedSource::ReplayedSource(const std::string& path, const Json& json, std::size_t index,
                               Scene& scene)
    : reader_(path) {
  from_.plan.argument.name = json.at("name").get<std::string>();
  take_exact(json.at("options"), from_.plan.options);
  from_.plan.as_cloud = json.at("as_cloud").get<bool>();
  source_ = &scene.add(from_.plan.argument.name, from_.plan.options);
  const std::string topic = json.at("topic").get<std::string>() + "/";
  reader_.choose([&](const bag::Channel& each) { return each.topic.starts_with(topic); });
  lives_ = json.at("lives").get<bool>();
  if (!lives_) show_surface(reader_, index, json, from_.plan.options, *source_);
}

bool ReplayedSource::push_until(std::uint64_t publication) {
  while (done_ < publication) {
    if (!lives_ || !push_next()) return false;
  }
  return SourceTrace(*source_).publications() == done_;
}

void ReplayedSource::widen(double least_radius) {
  SourceTrace(*source_).impose_least_radius(least_radius);
}

bool ReplayedSource::push_next() {
  for (bag::Message message; reader_.next(message);) {
    const std::string& type = reader_.channel_of(message).schema.name;
    if (type == message::ros_name(message::CameraInfo::kName)) {
      message::CameraInfo info;
      message::decode(message.data, info);
      frame_.camera = lens_of(info);
    } else if (type == message::ros_name(message::Image::kName)) {
      message::Image image;
      message::decode(message.data, image);
      take_depths(image, frame_);
    } else if (type == message::ros_name(message::Cloud::kName)) {
      message::Cloud cloud;
      message::decode(message.data, cloud);
      frame_.cloud = std::make_shared<PointCloud>(cloud_of(cloud));
    } else if (type == message::ros_name(message::FrameUse::kName)) {
      message::FrameUse use;
      message::decode(message.data, use);
      do_again(use);
      return true;
    }
  }
  return false;
}

void ReplayedSource::do_again(const message::FrameUse& use) {
  done_ = use.publication;
  if (use.dropped) return;
  if (!use.options.empty()) {
    SourceOptions options;
    take_exact(Json::parse(use.options), options);
    source_->change(options);
  }
  std::vector<Reach> reach;
  for (std::size_t i = 0; i + 3 < use.reach.size(); i += 4) {
    reach.push_back({Eigen::Vector3d(use.reach.data() + i), use.reach[i + 3]});
  }
  SourceTrace(*source_).impose_reach(reach);
  if (use.kind == "end") return source_->keep();
  frame_.stamp = use.stamp;
  frame_.T_world_sensor.reset();
  if (!use.pose.empty()) frame_.T_world_sensor = pose_of_rows(use.pose);
  try {
    push_frame(from_, *source_, frame_, [&] { return use.start; });
  } catch (const Error&) {
    if (use.why_not.empty()) throw;  // else it was refused in the run, too
  }
  frame_.cloud.reset();
}

}  // namespace palpate::app
