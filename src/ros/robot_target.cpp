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
      due_(options.rate) {}

void RobotTarget::look(const ServoState& state, double now, const message::Time& stamp) {
  if (state.step != step_) stepped_ = now;
  step_ = state.step;
  if (!due_.due(now) || now - stepped_ > kStill || !may_go(state)) return;
  const Eigen::Vector3d position = options_.hand ? state.hip : state.contact.proxy;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = options_.T_robot_world.linear() * state.orientation.toRotationMatrix();
  pose.translation() = options_.T_robot_world * Eigen::Vector3d(options_.scale * position);
  target_.write({{stamp, options_.frame}, message::pose_of(pose)});
}

bool RobotTarget::may_go(const ServoState& state) const {
  // Without a surface, or behind one, a proxy is where the hand is: perhaps inside of things.
  const bool unbounded = has(state.field_notes, FieldNote::no_surface | FieldNote::behind);
  // And in the step in which a surface moved over it, it may still be a little inside.
  const bool inside =
      has(state.contact.notes, ContactNote::reanchored | ContactNote::not_converged);
  if ((unbounded || inside) && !options_.hand) return false;
  const bool held = !options_.dead_man || ((state.buttons >> *options_.dead_man) & 1U) != 0;
  return held && state.step > 0 && state.device == DeviceState::Status::ok &&
         state.guard.fault == Guard::Fault::none && !state.paused;
}

}  // namespace palpate::ros
