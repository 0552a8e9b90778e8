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
#include "servo/allowed_step.hpp"
#include "servo/servo_rig.hpp"
#include "support/effort.hpp"
#include "support/random_hand.hpp"
#include "support/snapshots.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kRatedForce = 8;  // of the device, N
constexpr int kClutch = 2;         // its button

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
  clutch,
};
constexpr int kFaults = 15;
constexpr unsigned kLongestClutch = 25;  // steps
constexpr int kLongestWay = 400;         // to a contact, steps
constexpr double kWorthFading = 0.5;     // N

// Faults of the device and of time leave no force, from the same step on.
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

// A hand at a sheet, and somebody who breaks things.
class Ordeal {
 public:
  explicit Ordeal(unsigned seed) : random_(seed), hand_(seed, 0.015), source_(scene_.add("sheet")) {
    show(0);
  }

  // Steps until `faults` were made, each within a dozen steps; for a clutch, which is held longer,
  // it waits until there is a force that can fade.
  void run(int faults) {
    for (int i = 0; i < faults; ++i) {
      fault_ = static_cast<Fault>(random_() % kFaults);
      for (unsigned rest = random_() % 6; rest > 0; --rest) step(false);
      if (fault_ == Fault::clutch) touch();
      const unsigned longest = fault_ == Fault::clutch ? kLongestClutch : 3;
      for (unsigned wrong = 1 + random_() % longest; wrong > 0; --wrong) step(true);
      mend();
      for (unsigned rest = random_() % 6; rest > 0; --rest) step(false);
      ++counts_[static_cast<std::size_t>(fault_)];
    }
  }

  [[nodiscard]] int steps() const { return steps_; }
  [[nodiscard]] int felt() const { return felt_; }
  [[nodiscard]] int felt_clutched() const { return felt_clutched_; }
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
    options.clutch_button = kClutch;
    return options;
  }

  void touch() {
    for (int i = 0; i < kLongestWay && force_.norm() < kWorthFading; ++i) step(false);
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
        state.status = DeviceState::Status::silent;
        break;
      case Fault::device_fails:
        state.status = DeviceState::Status::failed;
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
        stiffness_ = 500 * std::abs(uniform());
        servo_.set_contact({.stiffness = stiffness_});
        break;
      case Fault::another_field:
        servo_.set_field({.kind = static_cast<FieldOptions::Kind>(random_() % 3)});
        break;
      case Fault::clutch:
        state.buttons = 1u << kClutch;
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
    const bool faulted = state.guard.fault != Guard::Fault::none;
    if (fatal || faulted) {
      ASSERT_EQ(state.force, Vector3d::Zero()) << "fault " << static_cast<int>(fault_);
    }
    if (faulted) {
      allowed_.forget();
    } else {
      judge_step(state);
    }
    if (!state.force.isZero(0)) ++felt_;
    if (!state.force.isZero(0) && state.clutched) ++felt_clutched_;
    force_ = state.force;
  }

  // What a guard ought to be told: the hand goes its own way while the clutch is held, and touches
  // nothing.
  [[nodiscard]] Guard::Input told(const ServoState& state) {
    Guard::Input input;
    input.hip = device_.state().position;
    input.velocity = device_.state().velocity;
    input.dt = state.dt;
    input.stiffness = std::min(stiffness_, servo_.stiffness_limit());
    if (state.clutched) return input;
    input.normal = state.contact.normal;
    input.drift = state.contact.drift;
    input.stiffness = state.contact.stiffness;
    return input;
  }

  void judge_step(const ServoState& state) {
    const double allowed = allowed_(told(state), state.guard.notes);
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
  double stiffness_ = servo_.options().proxy.stiffness;  // as it is asked for, N/m
  double now_ = 0;
  double nearest_ = 0;
  int steps_ = 0;
  int felt_ = 0;
  int felt_clutched_ = 0;
  std::array<int, kFaults> counts_{};
};

class Faults : public testing::TestWithParam<unsigned> {};

TEST_P(Faults, MakeNoForceThatIsTooLongOrLeaps) {
  Ordeal ordeal(GetParam());
  ordeal.run(effort(10'000));
  RecordProperty("steps", ordeal.steps());
  RecordProperty("felt", ordeal.felt());
  EXPECT_GT(ordeal.felt(), ordeal.steps() / 50) << "too little was felt to tell";
  RecordProperty("felt_clutched", ordeal.felt_clutched());
  EXPECT_GT(ordeal.felt_clutched(), 0) << "no force had to fade";
  EXPECT_GT(ordeal.nearest_to_allowed(), 0.99) << "the bound is never reached: it tells nothing";
  for (const int count : ordeal.counts()) EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(TenThousandTimes, Faults, testing::Range(1u, 11u));

}  // namespace
}  // namespace palpate::test
