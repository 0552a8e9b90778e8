// Integrates a simulated device and the hand that holds it.
#include "palpate/device/simulated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/requirement.hpp"
#include "device/held_mass.hpp"
#include "device/held_wrist.hpp"
#include "device/target_motion.hpp"
#include "geometry/turn.hpp"
#include "geometry/wrench.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kMostDelay = 16;  // steps of delay, at most (judgement)

SimulatedDeviceOptions checked(const SimulatedDeviceOptions& o) {
  const Requirement require{"simulated device"};
  require.positive("mass", o.mass, "give a positive number of kilograms");
  require.not_negative("damping", o.damping, "give 0 or more N s/m");
  require.not_negative("coulomb", o.coulomb, "give 0 or more newtons");
  require.not_negative("resolution", o.resolution, "give 0 or more metres");
  require(o.delay >= 0 && o.delay <= kMostDelay, "delay", o.delay, "give 0 to 16 steps");
  require.positive("rate", o.rate, "give a positive number of steps per second");
  require.positive("maximum_force", o.maximum_force, "give a positive force in newtons");
  require.not_negative("hand.stiffness", o.hand.stiffness, "give 0 or more N/m");
  require.not_negative("hand.damping", o.hand.damping, "give 0 or more N s/m");
  require.positive("hand.maximum_force", o.hand.maximum_force, "give a positive force in newtons");
  const double duration = o.duration.value_or(0);
  require.not_negative("duration", duration, "give 0 or more seconds");
  require(o.position.allFinite(), "position", o.position.norm(), "give finite coordinates");
  require(o.velocity.allFinite(), "velocity", o.velocity.norm(), "give a finite velocity");
  return o;
}

DeviceInfo info_of(const SimulatedDeviceOptions& options) {
  DeviceInfo info;
  info.name = "simulated";
  info.maximum_force = options.maximum_force;
  info.damping = options.damping;
  info.mass = options.mass;
  info.rate = options.rate;
  info.delay = options.delay / options.rate;
  info.workspace_radius = options.workspace_radius;
  info.keeps_time = true;
  if (options.wrist) {
    info.has_orientation = info.has_gripper = true;
    info.maximum_torque = options.wrist->maximum_torque;
    info.angular_damping = options.wrist->damping;
    info.inertia = options.wrist->inertia.minCoeff();
  }
  return info;
}

}  // namespace

struct SimulatedDevice::Inside {
  Inside(const SimulatedDeviceOptions& the_options, Trajectory rows)
      : options(checked(the_options)), info(info_of(options)), mass(options) {
    if (!rows.empty()) check(rows);
    trajectory = Playback(std::move(rows));
    if (!options.duration && !trajectory.empty()) options.duration = trajectory.end();
    if (!trajectory.empty()) mass.position = trajectory.front().position;
    if (options.wrist) wrist.emplace(*options.wrist);
  }

  [[nodiscard]] TargetSource::Target target_at(double time) noexcept;
  [[nodiscard]] Vector3d quantised() const noexcept {
    if (options.resolution == 0) return mass.position;
    return (mass.position / options.resolution).array().round().matrix() * options.resolution;
  }
  [[nodiscard]] Eigen::Quaterniond resting() const noexcept {
    return options.wrist ? options.wrist->orientation : Eigen::Quaterniond::Identity();
  }
  [[nodiscard]] bool fetch(double time) noexcept;
  void begin() noexcept;
  void show() noexcept;
  void advance() noexcept;
  void fail(const char* what) noexcept;

  SimulatedDeviceOptions options;
  Playback trajectory;
  TargetSource* source = nullptr;
  TargetSource::Target target;  // at the current time
  DeviceInfo info;
  HeldMass mass;
  std::optional<HeldWrist> wrist;
  std::array<Wrench, kMostDelay + 1> wrenches;  // ring of written ones
  std::uint64_t steps = 0;
  DeviceState state;
  bool started = false;
  const char* wrong = nullptr;  // once the device has failed
};

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, Trajectory target)
    : inside_(std::make_unique<Inside>(options, std::move(target))) {}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, TargetSource& source)
    : SimulatedDevice(options) {
  inside_->source = &source;
}

SimulatedDevice::~SimulatedDevice() = default;

const DeviceInfo& SimulatedDevice::info() const noexcept {
  return inside_->info;
}

const Vector3d& SimulatedDevice::true_position() const noexcept {
  return inside_->mass.position;
}

const Vector3d& SimulatedDevice::true_velocity() const noexcept {
  return inside_->mass.velocity;
}

double SimulatedDevice::work() const noexcept {
  return inside_->mass.work + (inside_->wrist ? inside_->wrist->work() : 0);
}

DeviceState SimulatedDevice::read() noexcept {
  Inside& in = *inside_;
  if (in.wrong != nullptr || in.state.status == DeviceState::Status::finished) return in.state;
  if (in.started) {
    in.advance();
  } else {
    in.begin();
  }
  if (in.wrong != nullptr) return in.state;
  in.show();
  in.state.time = static_cast<double>(in.steps) / in.options.rate;
  in.started = true;
  // Half a step of slack: the end of a trajectory need not be a whole number of steps.
  if (in.options.duration && in.state.time > *in.options.duration + 0.5 / in.options.rate) {
    in.state.status = DeviceState::Status::finished;
  }
  return in.state;
}

void SimulatedDevice::write_wrench(const Wrench& wrench) noexcept {
  Inside& in = *inside_;
  if (in.wrong != nullptr) return;
  if (!is_finite(wrench)) {
    in.fail("the force or torque written was not finite");
    return;
  }
  in.wrenches[in.steps % in.wrenches.size()] =
      shortened(wrench, in.options.maximum_force, in.info.maximum_torque, 0);
}

const Eigen::Quaterniond& SimulatedDevice::true_orientation() const noexcept {
  static const Eigen::Quaterniond kStraight = Eigen::Quaterniond::Identity();
  return inside_->wrist ? inside_->wrist->orientation() : kStraight;
}

std::string SimulatedDevice::reason() const {
  const Inside& in = *inside_;
  if (in.wrong == nullptr) return {};
  return fmt::format("{} at t = {} s; mend the code that computed it", in.wrong, in.state.time);
}

void SimulatedDevice::Inside::fail(const char* what) noexcept {
  wrong = what;
  state.status = DeviceState::Status::failed;
}

TargetSource::Target SimulatedDevice::Inside::target_at(double time) noexcept {
  if (source != nullptr) return source->target(time, mass.position);
  TargetSource::Target along;
  along.position = options.position;
  along.orientation = resting();
  if (trajectory.empty()) return along;
  const Pose pose = trajectory.at(time);
  along.position = pose.position;
  if (trajectory.front().orientation) along.orientation = pose.orientation;
  along.opening = pose.opening;
  return along;
}

// Fetches the target at `time`; false if it is not valid.
bool SimulatedDevice::Inside::fetch(double time) noexcept {
  target = target_at(time);
  if (!target.position.allFinite()) fail("the target of the hand was not finite");
  if (!(target.maximum_force > 0)) fail("the largest force of the hand was not above 0");
  if (!is_about_unit(target.orientation) || !std::isfinite(target.opening)) {
    fail("the orientation or opening of the hand's target was not valid");
  }
  return wrong == nullptr;
}

void SimulatedDevice::Inside::begin() noexcept {
  if (!fetch(0)) return;
  const bool turned = !trajectory.empty() && trajectory.front().orientation;
  if (source != nullptr) mass.position = target.position;
  if (wrist && (source != nullptr || turned)) wrist->put(target.orientation.normalized());
}

// What the encoders read, and how fast it changes.
void SimulatedDevice::Inside::show() noexcept {
  const Vector3d shown = quantised();
  if (started) state.velocity = (shown - state.position) * options.rate;
  state.position = shown;
  state.buttons = target.buttons;
  if (!wrist) return;
  const Eigen::Quaterniond turned = wrist->shown();
  if (started) state.angular_velocity = turn_between(state.orientation, turned) * options.rate;
  state.orientation = turned;
  state.gripper = target.opening;
}

void SimulatedDevice::Inside::advance() noexcept {
  const TargetSource::Target from = target;
  if (!fetch(static_cast<double>(steps + 1) / options.rate)) return;
  const auto delay = static_cast<std::size_t>(options.delay);
  const Wrench& sent = wrenches[(steps + wrenches.size() - delay) % wrenches.size()];
  const Vector3d held = sent.force;
  const Vector3d goal_rate = (target.position - from.position) * options.rate;
  const Vector3d drive = options.hand.damping * goal_rate;
  Vector3d push = held + options.hand.stiffness * from.position + drive;
  Vector3d push_rate = options.hand.stiffness * goal_rate;
  // The hand's own damper only brakes; the limit applies to the rest, its pull.
  const double most =
      std::min({options.hand.maximum_force, from.maximum_force, target.maximum_force});
  const Vector3d pull = options.hand.stiffness * (from.position - mass.position) + drive;
  if (pull.norm() > most) {
    push = held + options.hand.stiffness * mass.position + most * pull.normalized();
    push_rate.setZero();
  }
  mass.advance(held, push, push_rate);
  if (wrist) {
    wrist->advance(from.orientation.normalized(), target.orientation.normalized(), sent.torque,
                   1 / options.rate);
  }
  // A step without a write() repeats the one before it.
  wrenches[(steps + 1) % wrenches.size()] = wrenches[steps % wrenches.size()];
  ++steps;
}

}  // namespace palpate
