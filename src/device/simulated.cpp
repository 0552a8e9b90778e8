#include "palpate/device/simulated.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/requirement.hpp"
#include "palpate/device/scripted.hpp"

namespace palpate {

namespace {

constexpr int kParts = 16;         // of a step, for the direction of dry friction
constexpr int kEvents = 4;         // stops and starts followed in one part
constexpr int kBisections = 48;    // of a part, to find when the device stops
constexpr double kAtRest = 1e-12;  // m/s

// e^A by Taylor's series of A / 2^n, squared n times: exact to rounding for these small matrices.
Eigen::Matrix4d exponential(const Eigen::Matrix4d& a) {
  const double norm = a.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = norm > 0.5 ? std::ilogb(norm) + 2 : 0;
  const Eigen::Matrix4d scaled = std::ldexp(1.0, -squarings) * a;
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d sum = term;
  for (int i = 1; i <= 16; ++i) {
    term = Eigen::Matrix4d(term * scaled) / i;
    sum += term;
  }
  for (int i = 0; i < squarings; ++i) sum = Eigen::Matrix4d(sum * sum);
  return sum;
}

void check_options(const SimulatedDeviceOptions& o, std::size_t maximum_delay) {
  const Requirement require{"simulated device"};
  require.positive("mass", o.mass, "give a positive number of kilograms");
  require.not_negative("damping", o.damping, "give 0 or more N s/m");
  require.not_negative("coulomb", o.coulomb, "give 0 or more newtons");
  require.not_negative("resolution", o.resolution, "give 0 or more metres");
  require(o.delay >= 0 && o.delay <= static_cast<int>(maximum_delay), "delay", o.delay,
          "give 0 to 16 steps");
  require.positive("rate", o.rate, "give a positive number of steps a second");
  require.positive("maximum_force", o.maximum_force, "give a positive force in newtons");
  require.not_negative("hand.stiffness", o.hand.stiffness, "give 0 or more N/m");
  require.not_negative("hand.damping", o.hand.damping, "give 0 or more N s/m");
  require.positive("hand.maximum_force", o.hand.maximum_force, "give a positive force in newtons");
  const double duration = o.duration.value_or(0);
  require.not_negative("duration", duration, "give 0 or more seconds");
  require(o.position.allFinite(), "position", o.position.norm(), "give finite coordinates");
  require(o.velocity.allFinite(), "velocity", o.velocity.norm(), "give a finite velocity");
}

}  // namespace

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, Trajectory target)
    : options_(options) {
  check_options(options_, kMaximumDelay);
  if (!target.empty()) check(target);
  target_ = Playback(std::move(target));
  if (!options_.duration && !target_.empty()) options_.duration = target_.end();
  info_.name = "simulated";
  info_.maximum_force = options_.maximum_force;
  info_.damping = options_.damping;
  info_.mass = options_.mass;
  info_.rate = options_.rate;
  info_.delay = options_.delay / options_.rate;
  info_.workspace_radius = options_.workspace_radius;
  info_.keeps_time = true;
  position_ = options_.position;
  velocity_ = options_.velocity;
  forces_.fill(Eigen::Vector3d::Zero());
  generator_.setZero();
  generator_(0, 1) = 1;
  generator_(1, 0) = -options_.hand.stiffness / options_.mass;
  generator_(1, 1) = -(options_.damping + options_.hand.damping) / options_.mass;
  generator_(1, 2) = 1 / options_.mass;
  generator_(2, 3) = 1;
  whole_step_ = exponential(generator_ / options_.rate);
  part_step_ = exponential(generator_ / (options_.rate * kParts));
  if (!target_.empty()) position_ = target_.front().position;
}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, HandGuide& guide)
    : SimulatedDevice(options) {
  guide_ = &guide;
}

DeviceState SimulatedDevice::read() noexcept {
  if (wrong_ != nullptr || state_.status == DeviceStatus::finished) return state_;
  if (started_) {
    advance();
  } else {
    begin();
  }
  if (wrong_ != nullptr) return state_;
  const Eigen::Vector3d shown = quantised();
  if (started_) state_.velocity = (shown - state_.position) * options_.rate;
  state_.position = shown;
  state_.buttons = wish_.buttons;
  state_.time = static_cast<double>(steps_) / options_.rate;
  started_ = true;
  // Half a step of slack: the end of a target need not be a whole number of steps.
  if (options_.duration && state_.time > *options_.duration + 0.5 / options_.rate) {
    state_.status = DeviceStatus::finished;
  }
  return state_;
}

void SimulatedDevice::write(const Eigen::Vector3d& force) noexcept {
  if (wrong_ != nullptr) return;
  if (!force.allFinite()) {
    fail("the force written");
    return;
  }
  const double length = force.norm();
  const double shorten = length > options_.maximum_force ? options_.maximum_force / length : 1;
  forces_[steps_ % forces_.size()] = shorten * force;
}

std::string SimulatedDevice::reason() const {
  if (wrong_ == nullptr) return {};
  return fmt::format("{} at t = {} s was not finite; look for the fault in what computed it",
                     wrong_, state_.time);
}

void SimulatedDevice::fail(const char* wrong) noexcept {
  wrong_ = wrong;
  state_.status = DeviceStatus::failed;
}

// Times are asked for once each, in growing order.
HandWish SimulatedDevice::wanted(double time) noexcept {
  if (guide_ != nullptr) return guide_->wanted(time, position_);
  if (target_.empty()) return {options_.position, 0};
  return {target_.at(time), 0};
}

// The goal that pulls no harder than the hand does.
Eigen::Vector3d SimulatedDevice::within_reach(const Eigen::Vector3d& goal) const noexcept {
  const Eigen::Vector3d stretch = goal - position_;
  const double pull = options_.hand.stiffness * stretch.norm();
  if (pull <= options_.hand.maximum_force) return goal;
  return position_ + options_.hand.maximum_force / pull * stretch;
}

Eigen::Vector3d SimulatedDevice::quantised() const noexcept {
  if (options_.resolution == 0) return position_;
  return (position_ / options_.resolution).array().round().matrix() * options_.resolution;
}

void SimulatedDevice::begin() noexcept {
  wish_ = wanted(0);
  if (!wish_.position.allFinite()) return fail("the place that the hand wanted");
  if (guide_ != nullptr) position_ = wish_.position;
}

void SimulatedDevice::advance() noexcept {
  const double next = static_cast<double>(steps_ + 1) / options_.rate;
  const Eigen::Vector3d place = wish_.position;
  wish_ = wanted(next);
  if (!wish_.position.allFinite()) return fail("the place that the hand wanted");
  const Eigen::Vector3d goal_rate = (wish_.position - place) * options_.rate;
  const Eigen::Vector3d goal = within_reach(place);
  const std::size_t size = forces_.size();
  const auto delay = static_cast<std::size_t>(options_.delay);
  const Eigen::Vector3d held = forces_[(steps_ + size - delay) % size];
  const Eigen::Vector3d push =
      held + options_.hand.stiffness * goal + options_.hand.damping * goal_rate;
  const Eigen::Vector3d push_rate = options_.hand.stiffness * goal_rate;
  const Eigen::Vector3d before = position_;
  if (options_.coulomb > 0) {
    advance_with_friction(push, push_rate);
  } else {
    flow(whole_step_, push, push_rate);
  }
  work_ += held.dot(position_ - before);
  // A step without a write() goes on with the force before it.
  forces_[(steps_ + 1) % size] = forces_[steps_ % size];
  ++steps_;
}

void SimulatedDevice::advance_with_friction(const Eigen::Vector3d& push,
                                            const Eigen::Vector3d& push_rate) noexcept {
  const double part = 1 / (options_.rate * kParts);
  for (int i = 0; i < kParts; ++i) slide(part, push + i * part * push_rate, push_rate);
}

// One part of a step. The device may stop in it, and start again.
void SimulatedDevice::slide(double duration, Eigen::Vector3d push,
                            const Eigen::Vector3d& push_rate) noexcept {
  const double whole = duration;
  for (int event = 0; event < kEvents && duration > 0; ++event) {
    Eigen::Vector3d direction = velocity_;
    if (velocity_.norm() <= kAtRest) {
      velocity_.setZero();
      direction = push - options_.hand.stiffness * position_;
      if (direction.norm() <= options_.coulomb) return;  // held by dry friction
    }
    direction.normalize();
    const Eigen::Vector3d sliding_push = push - options_.coulomb * direction;
    const Eigen::Vector3d x = position_;
    const Eigen::Vector3d v = velocity_;
    flow(duration == whole ? part_step_ : exponential(generator_ * duration), sliding_push,
         push_rate);
    if (velocity_.dot(direction) > 0) return;
    double moving = 0;
    double stopped = duration;
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (moving + stopped);
      position_ = x;
      velocity_ = v;
      flow(exponential(generator_ * middle), sliding_push, push_rate);
      (velocity_.dot(direction) > 0 ? moving : stopped) = middle;
    }
    velocity_ -= direction.dot(velocity_) * direction;
    push += stopped * push_rate;
    duration -= stopped;
  }
}

void SimulatedDevice::flow(const Eigen::Matrix4d& transition, const Eigen::Vector3d& push,
                           const Eigen::Vector3d& push_rate) noexcept {
  const Eigen::Vector3d x = transition(0, 0) * position_ + transition(0, 1) * velocity_ +
                            transition(0, 2) * push + transition(0, 3) * push_rate;
  velocity_ = transition(1, 0) * position_ + transition(1, 1) * velocity_ +
              transition(1, 2) * push + transition(1, 3) * push_rate;
  position_ = x;
}

}  // namespace palpate
