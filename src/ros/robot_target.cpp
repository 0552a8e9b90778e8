// Sends a robot its target, or withholds it.
#include "ros/robot_target.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "message/transforms.hpp"
#include "palpate/base/error.hpp"

namespace palpate::ros {
namespace {

constexpr double kStill = 0.05;  // s without a step: the servo stands still (judgement)
constexpr std::string_view kNoSteps = "the servo makes no steps";
constexpr std::string_view kSilent = "no data from the hand";
constexpr std::string_view kSlow = "the network is too slow";

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

RobotShape shape_of(const RosBridgeOptions::Robot& robot, const ServoOptions& servo) {
  if (!servo.tool) return RobotShape(servo.field.tool_radius);
  if (servo.tool->opens())
    throw Error("robot: no target says how far a gripper is open; give the hand a rigid tool");
  std::vector<Ball> balls = robot.shape;
  if (balls.empty()) {
    for (const auto& sample : servo.tool->samples()) {
      balls.push_back({sample.position, sample.radius});
    }
  }
  return RobotShape(std::move(balls));
}

}  // namespace

double look_rate(const RosBridgeOptions& options) {
  constexpr double kGuide = 250;  // Hz; a guide is called at least so often (judgement)
  return options.robot ? std::max({options.rate, options.robot->rate, kGuide}) : options.rate;
}

RobotTarget::RobotTarget(const dds::Participant& participant,
                         const RosBridgeOptions::Robot& options, const Scene& scene,
                         const Servo& servo)
    : options_(options),
      servo_(servo),
      guide_(scene, options, shape_of(options, servo.options())),
      target_(participant, robot_topic(options), {.reliable = true}),
      due_(options.rate),
      state_{.topic = target_.topic()} {}

void RobotTarget::look(double now, const message::Time& stamp) {
  const ServoState state = servo_.state();
  if (state.step != step_) stepped_ = now;
  step_ = state.step;
  RobotGuide::Answer answer = decide(state, now);
  if (!due_.due(now)) return;
  const bool sent = answer.target && send(*answer.target, stamp);
  if (sent) at_ = answer.target;
  if (answer.target && !sent) {
    guide_.is_at(at_);
    answer = {.reason = kSlow, .why = std::string(kSlow)};
  }
  count(answer, now);
}

RobotGuide::Answer RobotTarget::decide(const ServoState& state, double now) {
  const bool down = options_.dead_man && ((state.buttons >> *options_.dead_man) & 1U) != 0;
  // While the hand is silent its button is unknown.
  const bool valid = state.device == DeviceState::Status::ok;
  const bool was_up = valid ? std::exchange(up_, !down) : up_;
  const std::string_view why = objection(state, now);
  if (why.empty()) return guide_.look(state, now, down && was_up);
  if (why == kSilent || why == kNoSteps) {
    guide_.miss_hand(now);
  } else {
    guide_.pause();
  }
  return {.reason = why, .why = std::string(why)};
}

bool RobotTarget::send(const Pose& target, const message::Time& stamp) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = options_.T_robot_world.linear() * target.orientation.toRotationMatrix();
  pose.translation() = options_.T_robot_world * Eigen::Vector3d(options_.scale * target.position);
  return target_.write({{stamp, options_.frame}, message::pose_of(pose)});
}

void RobotTarget::count(const RobotGuide::Answer& answer, double now) {
  const std::size_t readers = target_.readers();
  const std::lock_guard lock(mutex_);
  const double span = counted_ > 0 ? now - counted_ : 0;
  counted_ = now;
  state_.readers = readers;
  state_.why = answer.why;
  state_.reason = answer.reason;
  state_.retreats = answer.retreats;
  state_.age = answer.age;
  ++(answer.target ? state_.told : state_.held);
  if (!answer.reason.empty()) state_.waits[std::string(answer.reason)] += span;
}

RosBridge::RobotState RobotTarget::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

// Why the hand allows no target; empty: it does.
std::string_view RobotTarget::objection(const ServoState& state, double now) {
  if (state.step == 0 || now - stepped_ > kStill) return kNoSteps;
  if (state.device == DeviceState::Status::silent) return kSilent;
  if (state.device != DeviceState::Status::ok) return "the hand has ended";
  if (state.guard.fault != Guard::Fault::none) return "the hand has a fault";
  if (state.paused) return "the hand is paused";
  if (options_.dead_man && up_) return "the hand's dead-man button is up";
  return {};
}

}  // namespace palpate::ros
