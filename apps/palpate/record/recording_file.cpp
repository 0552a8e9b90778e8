// Writes the messages of a run to an MCAP file.
#include "apps/palpate/record/recording_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "apps/palpate/cli/version.hpp"
#include "message/depth_images.hpp"
#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "ros/hand_messages.hpp"
#include "session/options_json.hpp"
#include "session/recorded_messages.hpp"

namespace palpate::app {

namespace {

constexpr double kShown = 4e-3;  // s between a hand's messages for viewers: 250 Hz; judgement
constexpr const char* kWorld = "world";

// Replaces what a topic's name cannot hold.
std::string plain(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace

std::string last_part(const std::string& topic) {
  return topic.substr(topic.rfind('/') + 1);
}

namespace {

// Describes a hand with its present settings, not those it began with.
Json hand_json(const Servo& servo, const std::string& topic) {
  ServoOptions options = servo.options();
  const ContactSettings contact = servo.contact();
  options.field = servo.field();
  options.proxy.stiffness = contact.stiffness;
  options.proxy.friction = contact.friction;
  options.proxy.texture = contact.texture;
  return {{"topic", topic},
          {"device", session::exact_json(servo.device().info())},
          {"options", session::exact_json(options)}};
}

Json source_json(const LoadedSource& loaded, const Source& source, std::size_t index) {
  SourceOptions options = source.options();
  options.T_world_sensor = source.pose();
  Json json = {{"name", source.name()},
               {"topic", fmt::format("/palpate/{}_{}", plain(source.name()), index)},
               {"lives", loaded.camera != nullptr},
               {"as_cloud", loaded.plan.as_cloud},
               {"options", session::exact_json(options)}};
  if (loaded.camera || !loaded.image) return json;
  json["lens"] = session::exact_json(loaded.image->camera);
  json["pose"] = session::exact_json(loaded.image->T_world_sensor);
  return json;
}

}  // namespace

RecordedSetup setup_of(const LoadedScene& loaded, const std::vector<const Servo*>& servos,
                       std::int64_t epoch) {
  RecordedSetup setup;
  setup.epoch = epoch;
  Json sources = Json::array();
  Json hands = Json::array();
  for (std::size_t i = 0; i < loaded.scene.size(); ++i) {
    const LoadedSource& source = loaded.sources[i];
    sources.push_back(source_json(source, loaded.scene.source(i), i));
    setup.clouds.push_back(source.camera ? nullptr : source.cloud);
    setup.images.push_back(source.camera ? nullptr : source.image);
  }
  for (const Servo* servo : servos) {
    const std::string number = servos.size() > 1 ? std::to_string(hands.size() + 1) : "";
    hands.push_back(hand_json(*servo, "/palpate/hand" + number));
  }
  const bool turns = std::ranges::any_of(
      servos, [](const Servo* each) { return each->options().tool != nullptr; });
  setup.json = {{"kind", turns ? session::kToolSetupKind : session::kSetupKind},
                {"palpate", std::string(version())},
                {"epoch_ns", epoch},
                {"picture_axes", in_picture_axes(loaded)},
                {"sources", std::move(sources)},
                {"hands", std::move(hands)}};
  return setup;
}

void RecordingFile::begin(const RecordedSetup& setup) {
  epoch_ = setup.epoch;
  for (const Json& source : setup.json.at("sources")) {
    add_source(source.at("topic").get<std::string>(), source.at("lives").get<bool>());
  }
  for (const Json& hand : setup.json.at("hands")) {
    add_hand(hand.at("topic").get<std::string>(), !hand.at("options").at("tool").is_null());
  }
  transforms_ = writer_.add_topic<message::TFMessage>("/tf", {.reliable = true, .depth = 100});
  bag::Bytes bytes;
  for (std::size_t i = 0; i < live_.size(); ++i) {
    if (!setup.images[i] && !setup.clouds[i]) continue;
    if (setup.images[i]) {
      message::encode(message::image_of(*setup.images[i]), bytes);
    } else {
      message::encode(session::recorded(*setup.clouds[i]), bytes);
    }
    attach(session::surface_name(i), bytes, "application/octet-stream");
  }
  const std::string text = text_of(setup.json);
  attach(session::kSetupName, {text.begin(), text.end()}, "application/json");
}

void RecordingFile::add_hand(const std::string& topic, bool turns) {
  HandTopics& hand = hands_.emplace_back();
  hand.name = last_part(topic);
  if (turns) hand.tool = writer_.add_topic<message::ToolStep>(topic + "/tool");
  hand.tick = writer_.add_topic<message::Tick>(topic + "/tick");
  hand.change = writer_.add_topic<message::Change>(topic + "/change");
  hand.pose = writer_.add_topic<message::PoseStamped>(topic + "/pose");
  hand.proxy = writer_.add_topic<message::PoseStamped>(topic + "/proxy");
  hand.wrench = writer_.add_topic<message::WrenchStamped>(topic + "/wrench");
  hand.joy = writer_.add_topic<message::Joy>(topic + "/joy");
}

void RecordingFile::add_source(const std::string& topic, bool lives) {
  SourceTopics& topics = live_.emplace_back();
  topics.name = last_part(topic);
  if (!lives) return;
  topics.use = writer_.add_topic<message::FrameUse>(topic + "/use");
  topics.image = writer_.add_topic<message::Image>(topic + "/depth/image_raw");
  topics.info = writer_.add_topic<message::CameraInfo>(topic + "/depth/camera_info");
  topics.points = writer_.add_topic<message::PointCloud2>(topic + "/points");
  topics.cloud = writer_.add_topic<message::Cloud>(topic + "/cloud");
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
  if (input.contact) change(hand, state, "contact", session::exact_json(*input.contact));
  if (input.field) change(hand, state, "field", session::exact_json(*input.field));
  if (input.added) change(hand, state, "force", session::exact_json(*input.added));
  if (hand.tool) {
    message::ToolStep tool = session::tool_step_of(state, input.device);
    tool.header = header(state.time, kWorld);
    put(*hand.tool, state.time, tool);
  }
  message::Tick tick = session::tick_of(step, live_.size());
  tick.header = header(state.time, kWorld);
  put(hand.tick, state.time, tick);
  if (state.time - hand.shown >= kShown) show(hand, state);
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

void RecordingFile::write(const session::RecordedFrame& recorded_frame) {
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
    put(topics.cloud, time, session::recorded(*frame.cloud));
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

void RecordingFile::write(const RecordedRobot& recorded) {
  if (!robot_) robot_ = writer_.add_topic<message::DiagnosticArray>("/palpate/robot");
  put(*robot_, recorded.time,
      message::DiagnosticArray{header(recorded.time, kWorld), {recorded.status}});
}

}  // namespace palpate::app
