// Reads the recording of a run.
#include "session/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "message/cdr.hpp"
#include "message/depth_images.hpp"
#include "message/schema.hpp"
#include "palpate/base/error.hpp"
#include "session/frames.hpp"
#include "session/options_json.hpp"
#include "session/recorded_messages.hpp"

namespace palpate::session {

namespace {

constexpr double kEver = std::numeric_limits<double>::infinity();

// s to look back for the last step before a moment. Most often there is one just before it.
constexpr std::array<double, 4> kBack{0.02, 0.5, 20, kEver};

Eigen::Isometry3d pose_of_rows(const std::vector<double>& rows) {
  if (rows.size() != 12) throw Error(fmt::format("its pose has {} numbers, not 12", rows.size()));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = rows[static_cast<std::size_t>(i)];
  return pose;
}

// `what` of the file at `path` is read by `work`, or told to be damaged.
void read(const std::string& path, const char* what, const auto& work) {
  try {
    work();
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {} is damaged: {}", path, what, error.what()));
  }
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

Recording::Hand hand_of(const Json& json) {
  Recording::Hand hand;
  hand.topic = json.at("topic").get<std::string>();
  take_exact(json.at("device"), hand.device);
  take_exact(json.at("options"), hand.options);
  return hand;
}

Recording::Origin origin_of(const Json& json) {
  Recording::Origin origin;
  origin.name = json.at("name").get<std::string>();
  origin.topic = json.at("topic").get<std::string>();
  take_exact(json.at("options"), origin.options);
  origin.lives = json.at("lives").get<bool>();
  origin.as_cloud = json.at("as_cloud").get<bool>();
  if (!json.contains("lens")) return origin;
  take_exact(json.at("lens"), origin.lens);
  take_exact(json.at("pose"), origin.pose);
  return origin;
}

// Is it the last message of a frame?
bool take(const std::string& type, bag::View data, RecordedFrame& recorded) {
  DepthFrame& frame = recorded.frame;
  if (type == message::ros_name(message::CameraInfo::kName)) {
    message::CameraInfo info;
    message::decode(data, info);
    frame.camera = lens_of(info);
  } else if (type == message::ros_name(message::Image::kName)) {
    message::Image image;
    message::decode(data, image);
    take_depths(image, frame);
  } else if (type == message::ros_name(message::Cloud::kName)) {
    message::Cloud cloud;
    message::decode(data, cloud);
    frame.cloud = std::make_shared<PointCloud>(cloud_of(cloud));
  } else if (type == message::ros_name(message::FrameUse::kName)) {
    message::decode(data, recorded.use);
    frame.stamp = recorded.use.stamp;
    if (!recorded.use.pose.empty()) frame.T_world_sensor = pose_of_rows(recorded.use.pose);
    return true;
  }
  return false;
}

}  // namespace

Recording::Recording(bag::RandomFile file) : file_(std::move(file)), reader_(file_) {
  try {
    const bag::Attachment text = attachment(kSetupName);
    const Json setup = Json::parse(text.data.begin(), text.data.end());
    const Json& kind = setup.at("kind");
    if (kind != kSetupKind && kind != kToolSetupKind)
      throw Error("another version of palpate recorded it");
    epoch_ = whole_in<std::int64_t>(setup.at("epoch_ns"));
    in_picture_axes_ = setup.value("picture_axes", false);
    for (const Json& json : setup.at("hands")) hands_.push_back(hand_of(json));
    for (const Json& json : setup.at("sources")) sources_.push_back(origin_of(json));
    if (hands_.empty()) throw Error("no hand is in it");
    in_picture_axes_ = in_picture_axes_ && !sources_.empty();
  } catch (const std::bad_alloc&) {
    throw;  // it may well be one
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: no recording of a run: {}", path(), error.what()));
  }
}

bag::Attachment Recording::attachment(const std::string& name) const {
  const auto& attached = reader_.contents().attachments;
  for (std::size_t i = 0; i < attached.size(); ++i) {
    if (attached[i].head.name == name) return reader_.attachment(i);
  }
  const std::vector<std::string>& losses = reader_.contents().losses;
  throw Error(fmt::format(
      "there is no '{}' in it; {}", name,
      losses.empty() ? "give a file that palpate touch --record wrote" : losses.front()));
}

// ns since 1970; 0 for a time before 1970. Both are what a file says they are.
std::uint64_t Recording::logged_at(double time) const {
  constexpr double kMost = 9.2e18;  // ns: below the largest std::int64_t, 292 years
  const double ns = std::floor(1e9 * time);
  if (!(ns > -kMost)) return 0;
  const auto after = static_cast<std::int64_t>(std::min(ns, kMost));
  if (epoch_ < 0 && after < 0) return 0;
  if (epoch_ < 0 || after < 0) {
    return static_cast<std::uint64_t>(std::max<std::int64_t>(epoch_ + after, 0));
  }
  return static_cast<std::uint64_t>(epoch_) + static_cast<std::uint64_t>(after);
}

Recording::Stretch Recording::stretch() const {
  Stretch stretch{kEver, 0};
  const auto logged = static_cast<double>(reader_.contents().end);
  const double end = 1e-9 * (logged - static_cast<double>(epoch_)) + 1e-3;
  std::vector<std::string> losses;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    Steps steps(*this, i);
    const std::optional<Step> first = steps.next();
    losses = steps.losses();
    if (!first) continue;
    const Step last = steps.at(end).value_or(*first);
    stretch.begin = std::min(stretch.begin, first->tick.time);
    stretch.end = std::max(stretch.end, last.tick.time);
  }
  const bool is_one = stretch.begin <= stretch.end && std::isfinite(stretch.end - stretch.begin);
  if (!is_one) {
    const std::size_t before = reader_.contents().losses.size();  // any of the file was read
    if (losses.empty()) throw Error(path() + ": there is no step in it");
    throw Error(fmt::format("{}: there is no step in it; {}", path(),
                            losses.size() > before ? losses[before] : losses.back()));
  }
  return stretch;
}

Source& Recording::add_source(std::size_t index, Scene& scene) const {
  const Origin& origin = sources_.at(index);
  Source& source = scene.add(origin.name, origin.options);
  if (origin.lives) return source;
  const bag::Attachment attached = attachment(surface_name(index));
  Source prepared(origin.name, origin.options);
  if (origin.lens) {
    DepthFrame frame;
    message::Image image;
    message::decode(bag::View(attached.data), image);
    frame.camera = *origin.lens;
    frame.T_world_sensor = origin.pose;
    take_depths(image, frame);
    prepared.set(frame);
  } else {
    message::Cloud cloud;
    message::decode(bag::View(attached.data), cloud);
    prepared.set(cloud_of(cloud));
  }
  publish_surface(prepared, source);
  return source;
}

Recording::Steps::Steps(const Recording& recording, std::optional<std::size_t> hand)
    : recording_(&recording), reader_(recording.file_, recording.reader_.contents()) {
  for (std::size_t i = 0; i < recording.hands_.size(); ++i) {
    if (hand && *hand != i) continue;
    topics_[recording.hands_[i].topic + "/tick"] = i;
    topics_[recording.hands_[i].topic + "/change"] = i;
    topics_[recording.hands_[i].topic + "/tool"] = i;
  }
  seek(-kEver);
}

void Recording::Steps::seek(double time) {
  upcoming_.reset();
  changes_.assign(recording_->hands_.size(), {});
  tools_.assign(recording_->hands_.size(), {});
  reader_.choose([&](const bag::Channel& each) { return topics_.contains(each.topic); },
                 recording_->logged_at(time));
}

std::optional<Recording::Step> Recording::Steps::next(double until) {
  for (bag::Message message; !upcoming_ && reader_.next(message);) {
    const std::string& topic = reader_.channel_of(message).topic;
    const std::size_t hand = topics_.at(topic);
    if (topic.ends_with("/change")) {
      message::Change change;
      read(recording_->path(), "a change", [&] { message::decode(message.data, change); });
      changes_[hand].push_back(std::move(change));
      continue;
    }
    if (topic.ends_with("/tool")) {
      read(recording_->path(), "a step",
           [&] { message::decode(message.data, tools_[hand].emplace()); });
      continue;
    }
    message::Tick tick;
    read(recording_->path(), "a step", [&] {
      message::decode(message.data, tick);
      if (!std::isfinite(tick.time)) throw Error("it has no time");
    });
    std::optional<message::ToolStep>& tool = tools_[hand];
    if (tool && tool->step != tick.step) tool.reset();  // its own tick is lost
    upcoming_ = {hand, std::move(tick), tool, std::exchange(changes_[hand], {})};
    tool.reset();
  }
  if (!upcoming_ || upcoming_->tick.time > until) return std::nullopt;
  return std::exchange(upcoming_, std::nullopt);
}

std::optional<Recording::Step> Recording::Steps::at(double time) {
  for (const double back : kBack) {
    seek(time - back);
    std::optional<Step> last;
    while (std::optional<Step> step = next(time)) last = std::move(step);
    if (last) return last;
  }
  return next();
}

const std::vector<std::string>& Recording::Steps::losses() const {
  return reader_.contents().losses;
}

Recording::Frames::Frames(const Recording& recording, std::size_t source)
    : recording_(&recording),
      reader_(recording.file_, recording.reader_.contents()),
      topic_(recording.sources_.at(source).topic + "/") {
  seek(-kEver);
}

void Recording::Frames::seek(double time) {
  reader_.choose([&](const bag::Channel& each) { return each.topic.starts_with(topic_); },
                 recording_->logged_at(time));
}

std::optional<RecordedFrame> Recording::Frames::next() {
  RecordedFrame recorded;
  for (bag::Message message; reader_.next(message);) {
    const std::string& type = reader_.channel_of(message).schema.name;
    bool whole = false;
    read(recording_->path(), "a frame", [&] { whole = take(type, message.data, recorded); });
    if (whole) return recorded;
  }
  return std::nullopt;
}

}  // namespace palpate::session
