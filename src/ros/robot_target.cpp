#include "ros/robot_target.hpp"

#include <fmt/format.h>

#include <array>

#include "message/transforms.hpp"
#include "palpate/base/error.hpp"

namespace palpate::ros {
namespace {

constexpr double kStill = 0.05;  // s without a step: nobody computes where the proxy is

struct RobotPreset {
  std::string_view name;
  std::string_view ns;
  std::string_view topic;
};
constexpr std::array<RobotPreset, 5> kRobots = {
    {{"crisp", "", "/target_pose"},
     {"cartesian", "/cartesian_motion_controller", "/target_frame"},
     {"servo", "/servo_node", "/pose_target_cmds"},
     {"crtk", "/arm", "/servo_cp"},
     {"generic", "", ""}}};

std::string robot_topic(const RosBridgeOptions::Robot& robot) {
  const auto preset = std::ranges::find(kRobots, robot.preset, &RobotPreset::name);
  if (preset == kRobots.end()) {
    throw Error(fmt::format(
        "robot '{}': no such preset; there are crisp, cartesian, servo, crtk and generic",
        robot.preset));
  }
  if (!robot.topic.empty()) return robot.topic;
  if (preset->topic.empty())
    throw Error("robot generic needs topic=TOPIC, which takes a PoseStamped");
  return (robot.ns.empty() ? std::string(preset->ns) : robot.ns) + std::string(preset->topic);
}

}  // namespace

RobotTarget::RobotTarget(const dds::Participant& participant,
                         const RosBridgeOptions::Robot& options)
    : options_(options),
      target_(participant, robot_topic(options), {.reliable = true}),
      due_(options.rate),
      told_{.topic = target_.topic()} {}

void RobotTarget::look(const ServoState& state, double now, const message::Time& stamp) {
  if (state.step != step_) stepped_ = now;
  step_ = state.step;
  if (!due_.due(now)) return;
  std::string_view why = obstacle(state, now);
  if (why.empty() && !tell(state, stamp)) why = "the network is too slow";
  const std::lock_guard lock(mutex_);
  told_.readers = target_.readers();
  told_.why = why;
  ++(why.empty() ? told_.told : told_.held);
}

bool RobotTarget::tell(const ServoState& state, const message::Time& stamp) {
  const Eigen::Vector3d position = options_.hand ? state.hip : state.contact.proxy;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = options_.T_robot_world.linear() * state.orientation.toRotationMatrix();
  pose.translation() = options_.T_robot_world * Eigen::Vector3d(options_.scale * position);
  return target_.write({{stamp, options_.frame}, message::pose_of(pose)});
}

RosBridge::RobotState RobotTarget::state() const {
  const std::lock_guard lock(mutex_);
  return told_;
}

// Why no target may be told; empty: it may be.
std::string_view RobotTarget::obstacle(const ServoState& state, double now) const {
  if (state.step == 0 || now - stepped_ > kStill) return "the servo stands still";
  if (state.device == DeviceState::Status::silent) return "the hand is not heard";
  if (state.device != DeviceState::Status::ok) return "the hand has ended";
  if (state.guard.fault != Guard::Fault::none) return "the hand has a fault";
  if (state.paused) return "the hand is paused";
  if (options_.dead_man && ((state.buttons >> *options_.dead_man) & 1U) == 0)
    return "the hand's dead-man button is up";
  if (options_.hand) return {};
  // Without a surface, or behind one, a proxy is where the hand is: perhaps inside of things.
  if (has(state.field_notes, FieldNote::no_surface)) return "no source has a surface";
  if (has(state.field_notes, FieldNote::behind)) return "the tool is behind what a camera sees";
  // In the step in which a surface moved over it, it may still be a little inside.
  if (has(state.contact.notes, ContactNote::reanchored | ContactNote::not_converged))
    return "a surface moved over the tool";
  return {};
}

}  // namespace palpate::ros
