// A hundred thousand faults of device, clock, scene and user, at random moments of a random hand's
// way: no force is ever longer than the clamp, none is anything but a number, and none makes a step
// that neither the hand nor the guard's rate explains; but to zero, when something is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "palpate/scene/scene.hpp"
#include "servo/servo_rig.hpp"
#include "support/effort.hpp"
#include "support/random_hand.hpp"
#include "support/snapshots.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kRatedForce = 8;  // of the device, N

enum class Fault {
  place_is_no_number,
  place_is_infinite,
  velocity_is_no_number,
  place_leaps,
  device_falls_silent,
  device_fails,
  time_is_no_number,
  time_goes_back,
  servo_stands_still,
  surface_leaps,
  surface_vanishes,
  pause,
  another_stiffness,
  another_field,
};
constexpr int kFaults = 14;

// Of faults of the device and of time no force is left, from the same step on.
bool is_fatal(Fault fault) {
  switch (fault) {
    case Fault::place_is_no_number:
    case Fault::place_is_infinite:
    case Fault::velocity_is_no_number:
    case Fault::device_fails:
    case Fault::time_is_no_number:
    case Fault::time_goes_back:
    case Fault::servo_stands_still:
      return true;
    default:
      return false;
  }
}

// The largest step of force that is the hand's own doing or the guard's, computed anew from what
// the servo shows (docs/safety.md).
class AllowedStep {
 public:
  explicit AllowedStep(const GuardOptions& options) : options_(options) {}

  [[nodiscard]] double operator()(const ServoState& state) {
    const Vector3d relative = state.velocity - state.contact.drift;
    if (!begun_) {
      hip_ = state.hip;
      velocity_ = relative;
      stiffness_ = brake_ = 0;
      begun_ = true;
    }
    if (state.contact.stiffness > 0) loose_ = state.contact.stiffness;
    const Vector3d velocity = velocity_ + Guard::kSmoothing * (relative - velocity_);
    const Vector3d way = state.hip - hip_ - state.contact.drift * state.dt;
    const bool braked = has(state.guard.notes, GuardNote::braked);
    const double brake =
        braked ? options_.passivity.mass / (4 * state.dt * state.dt) * way.norm() : 0;
    const double loose = state.contact.normal.isZero(0) ? loose_ : 0;  // a spring that fades
    const double stiffness = std::max({state.contact.stiffness, stiffness_, loose});
    const double allowed = stiffness * (state.hip - hip_).norm() +
                           options_.damping * (velocity - velocity_).norm() +
                           options_.slew * state.dt + brake + brake_;
    hip_ = state.hip;
    velocity_ = velocity;
    stiffness_ = state.contact.stiffness;
    brake_ = brake;
    return allowed;
  }

  void forget() { begun_ = false; }

 private:
  GuardOptions options_;
  bool begun_ = false;
  Vector3d hip_ = Vector3d::Zero();
  Vector3d velocity_ = Vector3d::Zero();
  double stiffness_ = 0;
  double loose_ = 0;
  double brake_ = 0;
};

// A hand at a sheet, and somebody who breaks things.
class Ordeal {
 public:
  explicit Ordeal(unsigned seed) : random_(seed), hand_(seed, 0.015), source_(scene_.add("sheet")) {
    show(0);
  }

  // Steps until `faults` were made, each within a dozen steps.
  void run(int faults) {
    for (int i = 0; i < faults; ++i) {
      fault_ = static_cast<Fault>(random_() % kFaults);
      for (unsigned rest = random_() % 6; rest > 0; --rest) step(false);
      for (unsigned wrong = 1 + random_() % 3; wrong > 0; --wrong) step(true);
      mend();
      for (unsigned rest = random_() % 6; rest > 0; --rest) step(false);
      ++counts_[static_cast<std::size_t>(fault_)];
    }
  }

  [[nodiscard]] int steps() const { return steps_; }
  [[nodiscard]] int felt() const { return felt_; }
  [[nodiscard]] const std::array<int, kFaults>& counts() const { return counts_; }
  [[nodiscard]] double nearest_to_allowed() const { return nearest_; }

 private:
  static FreeDevice& rated(FreeDevice& device) {
    DeviceInfo& info = device.info();
    info.maximum_force = kRatedForce;
    info.damping = 0.5;
    info.mass = 0.1;
    info.delay = 1e-3;
    return device;
  }

  // Soft enough a start to be seen, short enough to be over before the next fault.
  static ServoOptions quick() {
    ServoOptions options;
    options.guard.soft_start = 3e-3;
    return options;
  }

  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

  void step(bool wrong) {
    const Vector3d before = device_.state().position;
    DeviceState& state = device_.state();
    state = {};
    state.position = hand_.next() + leap_;
    state.velocity =
        before.allFinite() ? Vector3d((state.position - before) / kTick) : Vector3d::Zero();
    now_ += kTick;
    double now = now_;
    if (wrong) now = break_something(state);
    if (std::isfinite(now)) now_ = std::max(now_, now);
    judge(servo_.tick(now), wrong && is_fatal(fault_));
    ++steps_;
  }

  // The time that is told.
  double break_something(DeviceState& state) {
    switch (fault_) {
      case Fault::place_is_no_number:
        state.position[static_cast<Eigen::Index>(random_() % 3)] = kNothing;
        break;
      case Fault::place_is_infinite:
        state.position.x() = -std::numeric_limits<double>::infinity();
        break;
      case Fault::velocity_is_no_number:
        state.velocity.y() = kNothing;
        break;
      case Fault::place_leaps:
        leap_ = 0.02 * Vector3d(uniform(), uniform(), uniform());
        break;
      case Fault::device_falls_silent:
        state.status = DeviceStatus::silent;
        break;
      case Fault::device_fails:
        state.status = DeviceStatus::failed;
        break;
      case Fault::time_is_no_number:
        return kNothing;
      case Fault::time_goes_back:
        return now_ - 0.05 - kTick;
      case Fault::servo_stands_still:
        return now_ + 0.1;
      case Fault::surface_leaps:
        show(5e-3 * uniform());
        break;
      case Fault::surface_vanishes:
        source_.publish(still({}, now_));
        break;
      case Fault::pause:
        servo_.pause(true);
        break;
      case Fault::another_stiffness:
        servo_.set_feel({.stiffness = 500 * std::abs(uniform())});
        break;
      case Fault::another_field:
        servo_.set_field({.kind = static_cast<FieldKind>(random_() % 3)});
        break;
    }
    return now_;
  }

  void mend() {
    leap_.setZero();
    servo_.pause(false);
    if (is_fatal(fault_)) {
      servo_.reset();
      allowed_.forget();
    }
    if (fault_ == Fault::surface_vanishes) show(0);
  }

  void show(double height) { source_.publish(still(plane(height, 5e-3, 8), now_)); }

  void judge(const ServoState& state, bool fatal) {
    ASSERT_TRUE(state.force.allFinite()) << "step " << steps_;
    ASSERT_LE(state.force.norm(), Servo::kForceShare * kRatedForce * (1 + 1e-12));
    const bool faulted = state.guard.fault != GuardFault::none;
    if (fatal || faulted) {
      ASSERT_EQ(state.force, Vector3d::Zero()) << "fault " << static_cast<int>(fault_);
    }
    if (faulted) {
      allowed_.forget();
    } else {
      judge_step(state);
    }
    if (!state.force.isZero(0)) ++felt_;
    force_ = state.force;
  }

  void judge_step(const ServoState& state) {
    const double allowed = allowed_(state);
    const double change = (state.force - force_).norm();
    if (has(state.guard.notes, GuardNote::silence)) return;
    ASSERT_LE(change, allowed + 1e-9)
        << "step " << steps_ << ", fault " << static_cast<int>(fault_);
    nearest_ = std::max(nearest_, change / allowed);
  }

  std::mt19937 random_;
  RandomHand hand_;
  FreeDevice device_;
  Scene scene_;
  Source& source_;
  Servo servo_{rated(device_), scene_, quick()};
  Fault fault_ = Fault::pause;
  AllowedStep allowed_{servo_.options().guard};
  Vector3d leap_ = Vector3d::Zero();
  Vector3d force_ = Vector3d::Zero();
  double now_ = 0;
  double nearest_ = 0;
  int steps_ = 0;
  int felt_ = 0;
  std::array<int, kFaults> counts_{};
};

class Faults : public testing::TestWithParam<unsigned> {};

TEST_P(Faults, MakeNoForceThatIsTooLongOrLeaps) {
  Ordeal ordeal(GetParam());
  ordeal.run(effort(10'000));
  RecordProperty("steps", ordeal.steps());
  RecordProperty("felt", ordeal.felt());
  EXPECT_GT(ordeal.felt(), ordeal.steps() / 50) << "too little was felt to tell";
  EXPECT_GT(ordeal.nearest_to_allowed(), 0.99) << "the bound is never reached: it tells nothing";
  for (const int count : ordeal.counts()) EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(TenThousandTimes, Faults, testing::Range(1u, 11u));

}  // namespace
}  // namespace palpate::test
