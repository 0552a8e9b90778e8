#include <algorithm>
#include <cmath>
#include <limits>

#include "base/requirement.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/z_width.hpp"

namespace palpate {

double passive_stiffness(const DeviceInfo& device, double damping) noexcept {
  if (!(device.maximum_force > 0) || !(device.rate > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  const double period = 1 / device.rate;
  return passive_stiffness(device.damping + damping, period, device.delay.value_or(period));
}

double Shaking::add(double place, double dt) noexcept {
  if (!started_) turned_at_ = farthest_ = place;
  started_ = true;
  since_farthest_ += dt;
  const double back = place - farthest_;
  if (direction_ * back >= 0 && back != 0) {  // goes on, or begins
    if (direction_ == 0) direction_ = back > 0 ? 1 : -1;
    farthest_ = place;
    since_turn_ += since_farthest_;
    since_farthest_ = 0;
  } else if (std::abs(back) > kSmallest) {  // has turned
    swing_ = since_turn_ < kSlowest ? std::abs(farthest_ - turned_at_) : 0;
    turned_at_ = farthest_;
    farthest_ = place;
    direction_ = -direction_;
    since_turn_ = since_farthest_;
    since_farthest_ = 0;
  }
  if (since_turn_ + since_farthest_ > 2 * kSlowest) swing_ = 0;
  return swing_;
}

namespace {

using Eigen::Vector3d;

constexpr double kGap = 5e-3;         // between a resting hand and the wall under it, m
constexpr double kStillFor = 0.5;     // s
constexpr double kStillSpeed = 0.02;  // m/s
constexpr double kLift = 2e-3;        // off the wall, m
constexpr double kLeastPress = 0.3;   // N
constexpr double kShakenFor = 0.25;   // s
constexpr double kMostForce = 4;      // N that a trial may ask for

void validate(const WallTrialOptions& options) {
  const Requirement require{"wall trial"};
  require.positive("softest (N/m)", options.softest, "give a stiffness above 0");
  require(options.stiffest >= options.softest && std::isfinite(options.stiffest), "stiffest (N/m)",
          options.stiffest, "give at least the softest");
  require(options.factor > 1 && options.factor <= 2, "factor", options.factor, "give 1 to 2");
  require.not_negative("damping (N s/m)", options.damping, "give a number that is 0 or more");
  require.positive("hold (s)", options.hold, "give a time above 0");
  require.positive("patience (s)", options.patience, "give a time above 0");
  require(options.maximum_force > kLeastPress && options.maximum_force <= kMostForce,
          "maximum_force (N)", options.maximum_force, "give 0.3 to 4 N");
  require.positive("fastest (m/s)", options.fastest, "give a speed above 0");
}

WallTrialOptions for_device(WallTrialOptions options, const DeviceInfo& device) {
  validate(options);
  if (device.maximum_force <= 0) {
    throw Error("wall trial: " + device.name + " renders no force; nothing can be measured");
  }
  if (device.maximum_stiffness > 0) {
    options.stiffest = std::min(options.stiffest, device.maximum_stiffness);
    options.softest = std::min(options.softest, options.stiffest);
  }
  return options;
}

// Without the links that would hide that a wall shakes.
GuardOptions bare(const WallTrialOptions& options, const DeviceInfo& device) {
  GuardOptions guard;
  guard.maximum_force = options.maximum_force;
  guard.damping = options.damping;
  guard.passivity.on = false;
  guard.soft_start = kStillFor / 2;
  return guard_for(device, guard);
}

}  // namespace

WallTrial::WallTrial(const DeviceInfo& device, const WallTrialOptions& options)
    : options_(for_device(options, device)), guard_(bare(options_, device)) {
  state_.wall = options_.softest;
}

Vector3d WallTrial::step(const DeviceState& hand, double now) noexcept {
  const double dt = started_ ? now - time_ : 0;
  if (!started_) since_ = now;
  started_ = true;
  time_ = now;
  if (!is_over()) advance(hand, now, dt);
  const Vector3d force = guard_.pass(felt(hand, dt));
  force_ = force.norm();
  return force;
}

void WallTrial::advance(const DeviceState& hand, double now, double dt) noexcept {
  const bool rests = state_.phase == WallTrialPhase::rest;
  if (hand.status == DeviceStatus::silent && now - since_ <= options_.patience) {
    if (!rests) go_to(WallTrialPhase::rest, now);
    return;
  }
  const bool known = hand.position.allFinite() && hand.velocity.allFinite();
  if (hand.status != DeviceStatus::ok || !known || !std::isfinite(dt)) {
    return go_to(WallTrialPhase::device_lost, now);
  }
  if (hand.velocity.norm() > options_.fastest) return go_to(WallTrialPhase::too_fast, now);
  if (now - since_ > options_.patience) return go_to(WallTrialPhase::gave_up, now);
  state_.amplitude = shaking_.add(hand.position.z(), dt);
  shaken_ = !rests && state_.amplitude > kShaking ? shaken_ + dt : 0;
  if (shaken_ > kShakenFor) return go_to(WallTrialPhase::shook, now);
  switch (state_.phase) {
    case WallTrialPhase::rest:
      still_ = hand.velocity.norm() < kStillSpeed ? still_ + dt : 0;
      if (still_ >= kStillFor) {
        top_ = hand.position.z() - kGap;
        go_to(WallTrialPhase::press, now);
      }
      return;
    case WallTrialPhase::press:
      return press(dt, now);
    case WallTrialPhase::lift:
      if (hand.position.z() < top_ + kLift) return;
      state_.stable = state_.wall;
      if (state_.wall >= options_.stiffest) return go_to(WallTrialPhase::held, now);
      state_.wall = std::min(options_.stiffest, options_.factor * state_.wall);
      return go_to(WallTrialPhase::press, now);
    default:
      return;
  }
}

// Only what the hand has felt whole counts: a force at its bound holds still whatever the wall.
void WallTrial::press(double dt, double now) noexcept {
  constexpr GuardNote kNotWhole =
      GuardNote::clamped | GuardNote::silence | GuardNote::starting | GuardNote::fault;
  const bool felt = force_ >= kLeastPress && !has(guard_.state().notes, kNotWhole);
  state_.pressed = felt && shaken_ == 0 ? state_.pressed + dt : 0;
  if (state_.pressed >= options_.hold) go_to(WallTrialPhase::lift, now);
}

void WallTrial::go_to(WallTrialPhase phase, double now) noexcept {
  state_.phase = phase;
  state_.pressed = shaken_ = 0;
  since_ = now;
}

GuardInput WallTrial::felt(const DeviceState& hand, double dt) const noexcept {
  GuardInput input;
  input.hip = hand.position;
  input.velocity = hand.velocity;
  input.dt = dt;
  input.felt = !is_over();
  const double depth = top_ - hand.position.z();
  if (!input.felt || state_.phase == WallTrialPhase::rest || !(depth > 0)) return input;
  input.force.z() = state_.wall * depth;
  input.normal.z() = 1;
  input.stiffness = state_.wall;
  return input;
}

std::string_view in_words(WallTrialPhase phase) noexcept {
  switch (phase) {
    case WallTrialPhase::rest:
      return "hold the device still near the middle of its workspace";
    case WallTrialPhase::press:
      return "press gently down on the wall and stay there";
    case WallTrialPhase::lift:
      return "good; lift off";
    case WallTrialPhase::shook:
      return "the wall made the device vibrate; the force is off";
    case WallTrialPhase::held:
      return "the stiffest wall that was tried is stable";
    case WallTrialPhase::gave_up:
      return "timed out; start again when you are ready";
    case WallTrialPhase::too_fast:
      return "the device moved faster than a pressing hand; the force is off";
    case WallTrialPhase::device_lost:
      return "the device stopped responding or failed";
  }
  return {};
}

}  // namespace palpate
