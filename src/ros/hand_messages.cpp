// Turns servo states into ROS messages and markers.
#include "ros/hand_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "message/point_clouds.hpp"
#include "message/transforms.hpp"
#include "palpate/geometry/point_cloud.hpp"

namespace palpate::ros {
namespace {

using namespace message;
using Eigen::Vector3d;
using message::Pose;

constexpr int kButtons = 8;
// visualization_msgs/Marker's types.
constexpr int kArrow = 0;
constexpr int kSphere = 2;
constexpr int kCylinder = 3;

Pose pose_at(const Vector3d& position, const Eigen::Quaterniond& q) {
  return {{position.x(), position.y(), position.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

Marker marker(const Header& header, int id, int type, const Pose& pose, const Vector3d& scale,
              const ColorRGBA& color) {
  Marker made;
  made.header = header;
  made.ns = "palpate";
  made.id = id;
  made.type = type;
  made.pose = pose;
  made.scale = vector_of(scale);
  made.color = color;
  made.lifetime = {0, 500'000'000};
  return made;
}

std::byte level_of(bool bad, bool doubtful) {
  return std::byte{static_cast<unsigned char>(bad ? 2 : doubtful ? 1 : 0)};
}

KeyValue fact(const std::string& key, double value, const char* unit) {
  return {key, fmt::format("{:.4g} {}", value, unit)};
}

}  // namespace

PoseStamped hand_pose(const Header& header, const ServoState& state) {
  return {header, pose_at(state.hip, state.orientation)};
}

PoseStamped proxy_pose(const Header& header, const ServoState& state) {
  return {header, pose_at(state.contact.proxy, state.tool.orientation)};
}

TwistStamped hand_twist(const Header& header, const ServoState& state) {
  return {header, {vector_of(state.velocity), {}}};
}

WrenchStamped hand_wrench(const Header& header, const ServoState& state) {
  return {header, {vector_of(state.force), vector_of(state.torque)}};
}

Joy hand_joy(const Header& header, const ServoState& state) {
  Joy joy{header, {static_cast<float>(state.gripper)}, {}};
  for (int k = 0; k < kButtons; ++k) joy.buttons.push_back((state.buttons >> k) & 1U ? 1 : 0);
  return joy;
}

TransformStamped proxy_frame(const Header& header, const std::string& name,
                             const ServoState& state) {
  const Pose pose = pose_at(state.contact.proxy, state.tool.orientation);
  return {header, "palpate_" + name, {vector_of(state.contact.proxy), pose.orientation}};
}

void add_markers(const Header& header, const ServoState& state, int index, double extent,
                 MarkerArray& markers) {
  const double size = 0.01 * extent;
  const Vector3d ball = Vector3d::Constant(2 * size);
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  const int id = 4 * index;
  const Vector3d& proxy = state.contact.proxy;
  markers.markers.push_back(marker(header, id, kSphere, pose_at(state.hip, upright), 0.7 * ball,
                                   {0.9F, 0.5F, 0.1F, 0.6F}));
  markers.markers.push_back(
      marker(header, id + 1, kSphere, pose_at(proxy, upright), ball, {0.1F, 0.4F, 0.9F, 1}));
  if (!state.contact.touching) return;
  const auto turned = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), state.contact.normal);
  markers.markers.push_back(marker(header, id + 2, kCylinder, pose_at(proxy, turned),
                                   {8 * size, 8 * size, 0.1 * size}, {0.1F, 0.4F, 0.9F, 0.3F}));
  Marker arrow = marker(header, id + 3, kArrow, pose_at(Vector3d::Zero(), upright),
                        {0.4 * size, size, size}, {0.1F, 0.7F, 0.2F, 1});
  const Vector3d tip = proxy + 0.05 * extent * state.force;
  arrow.points = {{proxy.x(), proxy.y(), proxy.z()}, {tip.x(), tip.y(), tip.z()}};
  markers.markers.push_back(arrow);
}

PointCloud2 surface_message(const Header& header, const Source& source, std::size_t most) {
  PointCloud cloud;
  const std::shared_ptr<const SurfacePoints> points = source.points();
  const std::size_t count = points ? points->size() : 0;
  const std::size_t stride = std::max<std::size_t>(1, (count + most - 1) / most);
  for (std::size_t i = 0; i < count; i += stride) {
    if (!points->presences.empty() && points->presences[i] <= 0) continue;
    cloud.positions.push_back(points->grid.points()[i]);
    if (!points->normals.empty()) cloud.normals.push_back(points->normals[i]);
  }
  if (points) cloud.origin = points->origin;
  PointCloud2 message = message_of(cloud);
  message.header = header;
  return message;
}

DiagnosticStatus hand_status(const std::string& name, const ServoState& state,
                             const StepDurations& last) {
  DiagnosticStatus status;
  const bool ended = has_ended(state.device);
  const std::string guard = in_words(state.guard);
  status.level = level_of(
      state.guard.fault != Guard::Fault::none || state.device == DeviceState::Status::failed,
      state.device == DeviceState::Status::silent);
  status.name = "palpate: " + name;
  status.message = ended                                         ? "ended"
                   : state.device == DeviceState::Status::silent ? "the device is silent"
                                                                 : guard;
  if (status.message.empty()) status.message = "ok";
  status.hardware_id = name;
  status.values = {fact("computing p99.9", 1e6 * last.computing.quantile(0.999), "us"),
                   fact("lateness p99.9", 1e6 * last.lateness.quantile(0.999), "us"),
                   fact("force", state.force.norm(), "N"),
                   {"guard", guard.empty() ? "nothing to do" : guard}};
  return status;
}

DiagnosticStatus stream_status(const StreamState& state) {
  DiagnosticStatus status;
  status.level = level_of(state.phase == StreamState::Phase::failed,
                          state.phase == StreamState::Phase::stalled);
  status.name = "palpate: " + state.source;
  status.message = name_of(state.phase);
  status.hardware_id = state.camera;
  status.values = {fact("rate", state.rate, "Hz"),
                   fact("age when touchable, mean", 1e3 * state.latency_mean, "ms"),
                   fact("age when touchable, worst", 1e3 * state.latency_worst, "ms"),
                   fact("age of what is felt", 1e3 * state.age, "ms"),
                   {"frames", std::to_string(state.frames)},
                   {"dropped", std::to_string(state.drops.total())},
                   {"problem", state.problem}};
  return status;
}

DiagnosticStatus robot_status(const RosBridge::RobotState& state) {
  DiagnosticStatus status;
  status.level = level_of(false, !state.why.empty() || state.readers == 0);
  status.name = "palpate: robot";
  status.message = state.reason.empty() ? "it follows"
                   : state.retreats     ? "it goes back: " + state.reason
                                        : "it waits: " + state.reason;
  status.hardware_id = state.topic;
  status.values = {{"subscribers", std::to_string(state.readers)},
                   {"targets", std::to_string(state.told)},
                   {"held back", std::to_string(state.held)},
                   fact("age of what it follows", 1e3 * state.age, "ms")};
  for (const auto& [reason, seconds] : state.waits) {
    status.values.push_back(fact("waited: " + reason, seconds, "s"));
  }
  return status;
}

}  // namespace palpate::ros
