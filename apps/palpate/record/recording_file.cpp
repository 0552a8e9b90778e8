#include "apps/palpate/record/recording_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/record/options_json.hpp"
#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "ros/hand_messages.hpp"

namespace palpate::app {

namespace {

constexpr double kShown = 4e-3;  // s between messages of a hand that are not ticks
constexpr const char* kWorld = "world";

// As a part of a topic's name.
std::string plain(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

std::vector<float> floats(const std::vector<Eigen::Vector3f>& vectors) {
  std::vector<float> values;
  for (const Eigen::Vector3f& v : vectors) values.insert(values.end(), {v.x(), v.y(), v.z()});
  return values;
}

std::vector<Eigen::Vector3f> vectors(const std::vector<float>& values) {
  std::vector<Eigen::Vector3f> made;
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) made.emplace_back(values.data() + i);
  return made;
}

message::Tick tick_of(const StepTrace& step, std::size_t sources) {
  const ServoState& state = step.state;
  const DeviceState& device = step.input.device;
  const SceneField::Found& found = step.input.found;
  const auto count = static_cast<std::ptrdiff_t>(sources);
  message::Tick tick;
  tick.step = state.step;
  tick.time = state.time;
  tick.dt = state.dt;
  tick.status = static_cast<std::uint8_t>(device.status);
  tick.device_time = device.time;
  tick.position = message::vector_of(device.position);
  tick.velocity = message::vector_of(device.velocity);
  const Eigen::Quaterniond& q = device.orientation;
  tick.orientation = {q.x(), q.y(), q.z(), q.w()};
  tick.buttons = device.buttons;
  tick.gripper = device.gripper;
  tick.paused = state.paused;
  tick.publications.assign(found.publications.begin(), found.publications.begin() + count);
  tick.least_radii.assign(found.least_radii.begin(), found.least_radii.begin() + count);
  tick.force = message::vector_of(state.force);
  tick.proxy = message::vector_of(state.contact.proxy);
  tick.contact_notes = static_cast<std::uint32_t>(state.contact.notes);
  tick.field_notes = static_cast<std::uint32_t>(state.field_notes);
  tick.guard_notes = static_cast<std::uint32_t>(state.guard.notes);
  tick.guard_fault = static_cast<std::uint8_t>(state.guard.fault);
  tick.computing = state.timing.computing;
  return tick;
}

}  // namespace

message::Cloud recorded(const PointCloud& cloud) {
  message::Cloud made;
  made.origin = message::vector_of(cloud.origin);
  made.positions = floats(cloud.positions);
  made.normals = floats(cloud.normals);
  made.intensities = cloud.intensities;
  if (const auto& from = cloud.viewpoint) made.viewpoint = {from->x(), from->y(), from->z()};
  made.width = cloud.width;
  made.height = cloud.height;
  made.pixels = cloud.pixels;
  return made;
}

PointCloud cloud_of(const message::Cloud& message) {
  PointCloud cloud;
  cloud.origin = message::eigen(message.origin);
  cloud.positions = vectors(message.positions);
  cloud.normals = vectors(message.normals);
  cloud.intensities = message.intensities;
  if (message.viewpoint.size() == 3) cloud.viewpoint.emplace(message.viewpoint.data());
  cloud.width = message.width;
  cloud.height = message.height;
  cloud.pixels = message.pixels;
  return cloud;
}

void RecordingFile::begin(LoadedScene& loaded, const std::vector<const Servo*>& servos,
                          std::int64_t epoch) {
  epoch_ = epoch;
  sources_ = loaded.scene.size();
  Json setup = {{"kind", kSetupKind}, {"palpate", std::string(version())}, {"epoch_ns", epoch}};
  setup["sources"] = Json::array();
  setup["hands"] = Json::array();
  for (std::size_t i = 0; i < sources_; ++i) {
    setup["sources"].push_back(add_source(loaded.sources[i], loaded.scene.source(i)));
  }
  for (const Servo* servo : servos) {
    const std::string number = servos.size() > 1 ? std::to_string(hands_.size() + 1) : "";
    setup["hands"].push_back(add_hand(*servo, "hand" + number));
  }
  transforms_ = writer_.add_topic<message::TFMessage>("/tf", {.reliable = true, .depth = 100});
  const std::string text = text_of(setup);
  attach(kSetupName, {text.begin(), text.end()}, "application/json");
}

Json RecordingFile::add_hand(const Servo& servo, const std::string& name) {
  const std::string topic = "/palpate/" + name;
  HandTopics& hand = hands_.emplace_back();
  hand.name = name;
  hand.tick = writer_.add_topic<message::Tick>(topic + "/tick");
  hand.change = writer_.add_topic<message::Change>(topic + "/change");
  hand.pose = writer_.add_topic<message::PoseStamped>(topic + "/pose");
  hand.proxy = writer_.add_topic<message::PoseStamped>(topic + "/proxy");
  hand.wrench = writer_.add_topic<message::WrenchStamped>(topic + "/wrench");
  hand.joy = writer_.add_topic<message::Joy>(topic + "/joy");
  return {{"topic", topic},
          {"device", exact_json(servo.device().info())},
          {"options", exact_json(servo.options())}};
}

Json RecordingFile::add_source(const LoadedSource& loaded, const Source& source) {
  SourceOptions options = source.options();
  options.T_world_sensor = source.pose();
  const std::string name = fmt::format("{}_{}", plain(source.name()), live_.size());
  const std::string topic = "/palpate/" + name;
  SourceTopics& topics = live_.emplace_back();
  topics.name = name;
  Json json = {{"name", source.name()},
               {"topic", topic},
               {"lives", loaded.camera != nullptr},
               {"as_cloud", loaded.plan.as_cloud},
               {"options", exact_json(options)}};
  if (loaded.camera) {
    topics.use = writer_.add_topic<message::FrameUse>(topic + "/use");
    topics.image = writer_.add_topic<message::Image>(topic + "/depth/image_raw");
    topics.info = writer_.add_topic<message::CameraInfo>(topic + "/depth/camera_info");
    topics.points = writer_.add_topic<message::PointCloud2>(topic + "/points");
    topics.cloud = writer_.add_topic<message::Cloud>(topic + "/cloud");
    return json;
  }
  bag::Bytes bytes;
  if (loaded.image) {
    message::encode(message::image_of(*loaded.image), bytes);
    json["lens"] = exact_json(loaded.image->camera);
    json["pose"] = exact_json(loaded.image->T_world_sensor);
  } else {
    message::encode(recorded(*loaded.cloud), bytes);
  }
  attach(surface_name(live_.size() - 1), bytes, "application/octet-stream");
  return json;
}

void RecordingFile::attach(const std::string& name, const bag::Bytes& bytes, const char* type) {
  const auto now = static_cast<std::uint64_t>(epoch_);
  writer_.attach({name, type, now, now, bytes});
}

message::Header RecordingFile::header(double time, const std::string& frame) const {
  const std::int64_t now = epoch_ + static_cast<std::int64_t>(std::llround(1e9 * time));
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {{static_cast<std::int32_t>(now / kSecond), static_cast<std::uint32_t>(now % kSecond)},
          frame};
}

template <class T>
void RecordingFile::put(std::uint16_t channel, double time, const T& message) {
  const auto now = static_cast<std::uint64_t>(epoch_ + std::llround(1e9 * time));
  writer_.write(channel, {now, now}, message);
}

void RecordingFile::change(const HandTopics& hand, const ServoState& state, const char* what,
                           const Json& value) {
  put(hand.change, state.time,
      message::Change{header(state.time, kWorld), state.step, what, value.dump()});
}

void RecordingFile::write(std::size_t index, const StepTrace& step) {
  HandTopics& hand = hands_[index];
  const ServoState& state = step.state;
  const StepInput& input = step.input;
  if (input.reset) change(hand, state, "reset", Json());
  if (input.contact) change(hand, state, "contact", exact_json(*input.contact));
  if (input.field) change(hand, state, "field", exact_json(*input.field));
  if (input.added) change(hand, state, "force", exact_json(*input.added));
  message::Tick tick = tick_of(step, sources_);
  tick.header = header(state.time, kWorld);
  put(hand.tick, state.time, tick);
  if (state.step == 1 || state.time - hand.shown >= kShown) show(hand, state);
}

void RecordingFile::show(HandTopics& hand, const ServoState& state) {
  hand.shown = state.time;
  const message::Header at = header(state.time, kWorld);
  put(hand.pose, state.time, ros::hand_pose(at, state));
  put(hand.proxy, state.time, ros::proxy_pose(at, state));
  put(hand.wrench, state.time, ros::hand_wrench(at, state));
  put(hand.joy, state.time, ros::hand_joy(at, state));
  put(transforms_, state.time, message::TFMessage{{ros::proxy_frame(at, hand.name, state)}});
}

void RecordingFile::write(const RecordedFrame& recorded_frame) {
  const DepthFrame& frame = recorded_frame.frame;
  SourceTopics& topics = live_[recorded_frame.source];
  topics.time = std::max(topics.time, recorded_frame.use.stamp);
  const double time = topics.time;
  const message::Header at = header(time, topics.name);
  if (frame.T_world_sensor) {
    put(transforms_, time,
        message::TFMessage{
            {{header(time, kWorld), topics.name, message::transform_of(*frame.T_world_sensor)}}});
  }
  if (frame.cloud) {
    message::PointCloud2 points = message::message_of(*frame.cloud);
    points.header = at;
    put(topics.points, time, points);
    put(topics.cloud, time, recorded(*frame.cloud));
  } else if (!frame.depth.empty()) {
    message::CameraInfo info = message::info_of(frame.camera);
    message::Image image = message::image_of(frame);
    info.header = image.header = at;
    put(topics.info, time, info);
    put(topics.image, time, image);
  }
  message::FrameUse use = recorded_frame.use;
  use.header = at;
  put(topics.use, time, use);
}

}  // namespace palpate::app
