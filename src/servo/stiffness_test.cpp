// Tests how stiff a wall one device renders stably with the hand that holds it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/latest.hpp"
#include "base/requirement.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/z_width.hpp"
#include "servo/oscillation.hpp"

namespace palpate {

double passive_stiffness(const DeviceInfo& device, double damping) noexcept {
  if (!(device.maximum_force > 0) || !(device.rate > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  const double period = 1 / device.rate;
  return passive_stiffness(device.damping + damping, period, device.delay.value_or(period));
}

double OscillationDetector::add(double position, double dt) noexcept {
  if (!started_) turned_at_ = farthest_ = position;
  started_ = true;
  since_farthest_ += dt;
  const double back = position - farthest_;
  if (direction_ * back >= 0 && back != 0) {  // goes on, or begins
    if (direction_ == 0) direction_ = back > 0 ? 1 : -1;
    farthest_ = position;
    since_turn_ += since_farthest_;
    since_farthest_ = 0;
  } else if (std::abs(back) > kSmallest) {  // has turned
    swing_ = since_turn_ < kSlowest ? std::abs(farthest_ - turned_at_) : 0;
    turned_at_ = farthest_;
    farthest_ = position;
    direction_ = -direction_;
    since_turn_ = since_farthest_;
    since_farthest_ = 0;
  }
  if (since_turn_ + since_farthest_ > 2 * kSlowest) swing_ = 0;
  return swing_;
}

namespace {

using Eigen::Vector3d;

constexpr double kGap = 5e-3;         // m between a resting hand and the wall under it (judgement)
constexpr double kStillFor = 0.5;     // s a hand has to rest (judgement)
constexpr double kStillSpeed = 0.02;  // m/s; slower counts as rest (judgement)
constexpr double kLift = 2e-3;        // m off the wall that end a lift (judgement)
constexpr double kLeastPress = 0.3;   // N that count as a press (judgement)
constexpr double kShakenFor = 0.25;   // s that shaking has to last (judgement)
constexpr double kMostForce = 4;      // N; largest maximum_force of a test (judgement)

void validate(const StiffnessTestOptions& options) {
  const Requirement require{"stiffness test"};
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

StiffnessTestOptions for_device(StiffnessTestOptions options, const DeviceInfo& device) {
  validate(options);
  if (device.maximum_force <= 0) {
    throw Error("stiffness test: " + device.name + " renders no force; nothing can be measured");
  }
  if (device.maximum_stiffness > 0) {
    options.stiffest = std::min(options.stiffest, device.maximum_stiffness);
    options.softest = std::min(options.softest, options.stiffest);
  }
  return options;
}

// Without the links that would hide that a wall shakes.
GuardOptions bare(const StiffnessTestOptions& options, const DeviceInfo& device) {
  GuardOptions guard;
  guard.maximum_force = options.maximum_force;
  guard.damping = options.damping;
  guard.passivity.on = false;
  guard.soft_start = kStillFor / 2;
  return guard_for(device, guard);
}

}  // namespace

struct StiffnessTest::Inside {
  Inside(const DeviceInfo& device, const StiffnessTestOptions& requested)
      : options(for_device(requested, device)), guard(bare(options, device)) {
    state.wall = options.softest;
    shown.set(state);
  }

  [[nodiscard]] Vector3d step(const DeviceState& hand, double now) noexcept;
  void advance(const DeviceState& hand, double now, double dt) noexcept;
  void press(double dt, double now) noexcept;
  void go_to(Phase phase, double now) noexcept;
  [[nodiscard]] bool is_over() const noexcept { return state.phase >= Phase::unstable; }
  [[nodiscard]] Guard::Input felt(const DeviceState& hand, double dt) const noexcept;

  StiffnessTestOptions options;
  Guard guard;
  OscillationDetector oscillation;
  State state;          // of the stepping thread
  Latest<State> shown;  // of the others
  double top = 0;       // z of the wall, m
  double since = 0;     // when the phase began, s
  double time = 0;      // of the step before, s
  double still = 0;     // s for which the hand has rested
  double shaken = 0;    // s for which the wall has shaken
  double force = 0;     // of the step before, N
  bool started = false;
};

StiffnessTest::StiffnessTest(const DeviceInfo& device, const StiffnessTestOptions& options)
    : inside_(std::make_unique<Inside>(device, options)) {}

StiffnessTest::~StiffnessTest() = default;

Vector3d StiffnessTest::step(const DeviceState& hand, double now) noexcept {
  return inside_->step(hand, now);
}

StiffnessTest::State StiffnessTest::state() const noexcept {
  return inside_->shown.get();
}

Vector3d StiffnessTest::Inside::step(const DeviceState& hand, double now) noexcept {
  const double dt = started ? now - time : 0;
  if (!started) since = now;
  started = true;
  time = now;
  if (!is_over()) advance(hand, now, dt);
  const Vector3d given = guard.pass(felt(hand, dt));
  force = given.norm();
  shown.set(state);
  return given;
}

void StiffnessTest::Inside::advance(const DeviceState& hand, double now, double dt) noexcept {
  const bool rests = state.phase == Phase::rest;
  if (hand.status == DeviceState::Status::silent && now - since <= options.patience) {
    if (!rests) go_to(Phase::rest, now);
    return;
  }
  const bool finite = hand.position.allFinite() && hand.velocity.allFinite();
  if (hand.status != DeviceState::Status::ok || !finite || !std::isfinite(dt)) {
    return go_to(Phase::device_lost, now);
  }
  if (hand.velocity.norm() > options.fastest) return go_to(Phase::too_fast, now);
  if (now - since > options.patience) return go_to(Phase::timed_out, now);
  state.amplitude = oscillation.add(hand.position.z(), dt);
  shaken = !rests && state.amplitude > kShaking ? shaken + dt : 0;
  if (shaken > kShakenFor) return go_to(Phase::unstable, now);
  switch (state.phase) {
    case Phase::rest:
      still = hand.velocity.norm() < kStillSpeed ? still + dt : 0;
      if (still >= kStillFor) {
        top = hand.position.z() - kGap;
        go_to(Phase::press, now);
      }
      return;
    case Phase::press:
      return press(dt, now);
    case Phase::lift:
      if (hand.position.z() < top + kLift) return;
      state.stable = state.wall;
      if (state.wall >= options.stiffest) return go_to(Phase::held, now);
      state.wall = std::min(options.stiffest, options.factor * state.wall);
      return go_to(Phase::press, now);
    default:
      return;
  }
}

// Counts for how long the hand felt the wall whole: a force at its bound holds still whatever the
// wall.
void StiffnessTest::Inside::press(double dt, double now) noexcept {
  constexpr GuardNote kNotWhole =
      GuardNote::clamped | GuardNote::silence | GuardNote::starting | GuardNote::fault;
  const bool is_felt = force >= kLeastPress && !has(guard.state().notes, kNotWhole);
  state.pressed = is_felt && shaken == 0 ? state.pressed + dt : 0;
  if (state.pressed >= options.hold) go_to(Phase::lift, now);
}

void StiffnessTest::Inside::go_to(Phase phase, double now) noexcept {
  state.phase = phase;
  state.pressed = shaken = 0;
  since = now;
}

Guard::Input StiffnessTest::Inside::felt(const DeviceState& hand, double dt) const noexcept {
  Guard::Input input;
  input.hip = hand.position;
  input.velocity = hand.velocity;
  input.dt = dt;
  input.felt = !is_over();
  const double depth = top - hand.position.z();
  if (!input.felt || state.phase == Phase::rest || !(depth > 0)) return input;
  input.force.z() = state.wall * depth;
  input.normal.z() = 1;
  input.stiffness = state.wall;
  return input;
}

std::string_view in_words(StiffnessTest::Phase phase) noexcept {
  switch (phase) {
    case StiffnessTest::Phase::rest:
      return "hold the device still near the middle of its workspace";
    case StiffnessTest::Phase::press:
      return "press gently down on the wall and stay there";
    case StiffnessTest::Phase::lift:
      return "good; lift off";
    case StiffnessTest::Phase::unstable:
      return "the wall made the device vibrate; the force is off";
    case StiffnessTest::Phase::held:
      return "the stiffest wall that was tried is stable";
    case StiffnessTest::Phase::timed_out:
      return "timed out; start again when you are ready";
    case StiffnessTest::Phase::too_fast:
      return "the device moved faster than a pressing hand; the force is off";
    case StiffnessTest::Phase::device_lost:
      return "the device stopped responding or failed";
  }
  return {};
}

}  // namespace palpate
