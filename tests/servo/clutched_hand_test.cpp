// The clutch of a servo: the hand moves freely, the tool rests, and nothing is given to the hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FreeDevice;

constexpr int kClutchButton = 1;
constexpr std::uint32_t kClutchDown = 1u << kClutchButton;
constexpr double kClutchSlew = 300;  // N/s, the guard's
const Vector3d kOverSheet(0.3e-3, 0.4e-3, 5e-3);

ServoOptions with_clutch(ServoOptions options = {}) {
  options.clutch_button = kClutchButton;
  return options;
}

class ClutchedHand : public testing::Test {
 protected:
  // A step of a millisecond with the hand at `z`.
  const ServoState& tick(double z, bool held = false) {
    device_.state().position = {kOverSheet.x(), kOverSheet.y(), z};
    device_.state().buttons = held ? kClutchDown : 1u;
    return servo_.tick(now_ += 1e-3);
  }
  // From one height to another in `steps`.
  const ServoState& go(double from, double to, int steps, bool held = false) {
    for (int i = 1; i <= steps; ++i) tick(from + (to - from) * i / steps, held);
    return tick(to, held);
  }

  Scene scene_;
  Source& sheet_ = test::add_sheet(scene_);
  FreeDevice device_{kOverSheet};
  Servo servo_{device_, scene_, with_clutch()};
  double now_ = 0;
};

TEST_F(ClutchedHand, ToolRestsInTheAirAndGoesOnFromThere) {
  go(5e-3, 20e-3, 10);
  EXPECT_FALSE(servo_.state().clutched);
  const ServoState& held = go(20e-3, -40e-3, 200, true);
  EXPECT_TRUE(held.clutched);
  EXPECT_NEAR(held.hip.z(), 20e-3, 1e-12);
  EXPECT_EQ(held.force, Vector3d::Zero());
  EXPECT_FALSE(held.contact.touching);
  const ServoState& after = go(-40e-3, -35e-3, 10);
  EXPECT_FALSE(after.clutched);
  EXPECT_NEAR(after.hip.z(), 25e-3, 1e-12);
  EXPECT_TRUE(after.shift.isApprox(Vector3d(0, 0, 60e-3), 1e-12)) << after.shift.transpose();
}

TEST_F(ClutchedHand, ForceGoesSoftlyAndComesBackOnlyWhenTheHandPushes) {
  go(5e-3, 5e-3, 600);  // past the soft start
  go(5e-3, -4e-3, 100);
  double force = tick(-4e-3).force.norm();
  ASSERT_NEAR(force, 2, 0.1);
  for (int i = 0; i < 10; ++i) {
    const double now = tick(-4e-3, true).force.norm();
    ASSERT_GE(now, force - kClutchSlew * 1.001e-3 - 1e-9) << "step " << i;
    ASSERT_LE(now, force);
    force = now;
  }
  EXPECT_EQ(force, 0);
  go(-4e-3, 30e-3, 50, true);
  EXPECT_EQ(servo_.state().force, Vector3d::Zero());
  EXPECT_NEAR(servo_.state().hip.z(), 0, 0.1e-3) << "it rests on the sheet";
  EXPECT_LT(go(30e-3, 30e-3, 1000).force.norm(), 1e-3) << "a resting hand";
  EXPECT_NEAR(go(30e-3, 26e-3, 100).force.norm(), 2, 0.1) << "felt at once";
  EXPECT_EQ(go(26e-3, 40e-3, 200).force, Vector3d::Zero());
  EXPECT_EQ(servo_.state().guard.fault, Guard::Fault::none);
}

TEST_F(ClutchedHand, ToolThatRestsIsTakenAlongByASurface) {
  go(5e-3, 5e-3, 600);
  go(5e-3, -2e-3, 100);
  for (int i = 0; i < 20; ++i) {
    sheet_.publish(test::still(test::plane(1e-3 * i), now_ + 2e-3));
    go(-2e-3, -2e-3, 10, true);
  }
  EXPECT_NEAR(servo_.state().hip.z(), 19e-3, 0.3e-3);
  EXPECT_LT(go(-2e-3, -2e-3, 500).force.norm(), 0.05);
}

TEST_F(ClutchedHand, ResetPutsTheToolBackToTheHand) {
  go(5e-3, 5e-3, 10);
  go(5e-3, 60e-3, 10, true);
  EXPECT_NEAR(tick(60e-3).hip.z(), 5e-3, 1e-12);
  servo_.reset();
  EXPECT_EQ(tick(60e-3).hip.z(), 60e-3);
  servo_.reset();
  EXPECT_EQ(tick(50e-3, true).hip.z(), 50e-3) << "held at once";
}

TEST_F(ClutchedHand, OtherButtonsAreNoClutch) {
  device_.state().buttons = ~kClutchDown;
  for (int i = 0; i < 10; ++i) servo_.tick(now_ += 1e-3);
  EXPECT_FALSE(servo_.state().clutched);
  Servo without(device_, scene_);
  device_.state().buttons = kClutchDown;
  without.tick(now_ += 1e-3);
  EXPECT_FALSE(without.tick(now_ += 1e-3).clutched);
}

TEST_F(ClutchedHand, WhatIsNoPlaceIsAFaultUntilReset) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {kNan, 1e300}) {
    go(5e-3, 8e-3, 10);
    go(8e-3, 9e-3, 10, true);
    EXPECT_NE(tick(bad, true).guard.fault, Guard::Fault::none);
    tick(7e-3, true);
    EXPECT_EQ(tick(7e-3).force, Vector3d::Zero());
    servo_.reset();
    EXPECT_EQ(tick(5e-3).guard.fault, Guard::Fault::none);
    EXPECT_EQ(servo_.state().hip.z(), 5e-3);
  }
}

TEST(Servo, RefusesAClutchThatNoDeviceHas) {
  Scene scene;
  FreeDevice device;
  for (const int button : {-1, 32}) {
    ServoOptions options;
    options.clutch_button = button;
    EXPECT_THROW(Servo(device, scene, options), Error) << button;
  }
}

// Presses as hard as it may, and is torn out as soon as the clutch is held.
class TornOut final : public TargetSource {
 public:
  [[nodiscard]] TargetSource::Target target(double time, const Vector3d&) noexcept override {
    if (time < 1) return {kOverSheet, 0};
    if (time < 2) return {{kOverSheet.x(), kOverSheet.y(), -25e-3}, 0};
    return {{kOverSheet.x(), kOverSheet.y(), -25e-3 + 4 * (time - 2)}, kClutchDown};
  }
};

// A force that only the slew takes away would push a hand on that leaves faster than that.
TEST(ClutchWhileTornOut, FadingForceGivesNoMoreThanTheSpringHeld) {
  constexpr double kStiffness = 2000;
  Scene scene;
  test::add_sheet(scene);
  TornOut guide;
  SimulatedDeviceOptions made;
  made.mass = 0.05;
  made.delay = 0;
  SimulatedDevice device(made, guide);
  ServoOptions options = with_clutch();
  options.proxy.stiffness = kStiffness;
  options.guard.stiffness_share = std::numeric_limits<double>::infinity();
  Servo servo(device, scene, options);
  double given = 0;
  double held = 0;
  Vector3d place = Vector3d::Zero();
  ServoState before;
  for (int i = 0; i < 2200; ++i) {
    const ServoState& state = servo.tick();
    if (before.clutched) given += before.force.dot(device.true_position() - place);
    if (!state.clutched) held = state.force.squaredNorm() / (2 * kStiffness);
    place = device.true_position();
    before = state;
  }
  EXPECT_GT(held, 8e-3) << "some 6 N";
  EXPECT_GT(given, 0);
  EXPECT_LT(given, held);
  EXPECT_EQ(before.force, Vector3d::Zero());
}

// A hand that wanders over and into the sheet, and holds and lets go the clutch, all at random.
class Restless final : public TargetSource {
 public:
  explicit Restless(unsigned seed) : random_(seed) {}

  [[nodiscard]] TargetSource::Target target(double time, const Vector3d&) noexcept override {
    if (time >= next_) {
      next_ = time + std::uniform_real_distribution<double>(0.02, 0.2)(random_);
      goal_ = {std::uniform_real_distribution<double>(-0.02, 0.02)(random_), 0.3e-3,
               std::uniform_real_distribution<double>(-0.015, 0.01)(random_)};
      const bool toggled = std::bernoulli_distribution(0.4)(random_);
      if (toggled) buttons_ ^= kClutchDown;
    }
    wish_ += 0.02 * (goal_ - wish_);
    return {wish_, buttons_};
  }

 private:
  std::mt19937 random_;
  double next_ = 0.6;
  Vector3d goal_{0, 0.3e-3, 5e-3};
  Vector3d wish_{0, 0.3e-3, 5e-3};
  std::uint32_t buttons_ = 0;
};

struct Wandering {
  double unpaid = 0;        // J given from a press of the clutch on, beyond what the spring held
  double felt = 0;          // N, the longest
  double largest_step = 0;  // N, that the hand does not explain, while the clutch is held
  int presses = 0;          // of the clutch, in contact
};

// Six seconds of it. The force of a step acts until the next one.
Wandering wander(unsigned seed) {
  constexpr double kStiffness = 500;
  Scene scene;
  test::add_sheet(scene);
  Restless guide(seed);
  SimulatedDeviceOptions made;
  made.delay = 0;
  SimulatedDevice device(made, guide);
  Servo servo(device, scene, with_clutch());
  Wandering result;
  double given = 0;                                       // since the clutch was pressed last, J
  double held = std::numeric_limits<double>::infinity();  // by the spring then, J
  ServoState before = servo.tick();
  Vector3d place = device.true_position();
  for (int i = 0; i < 6000; ++i) {
    const ServoState& state = servo.tick();
    given += before.force.dot(device.true_position() - place);
    place = device.true_position();
    if (state.clutched && !before.clutched) {
      held = before.force.squaredNorm() / (2 * kStiffness);
      given = 0;
      result.presses += held > 0 ? 1 : 0;
    }
    if (state.clutched) {
      const double explained =
          kStiffness * 1e-3 * state.velocity.norm() + (state.velocity - before.velocity).norm();
      const double step = (state.force - before.force).norm();
      result.largest_step = std::max(result.largest_step, step - explained);
    }
    result.unpaid = std::max(result.unpaid, given - held);
    result.felt = std::max(result.felt, state.force.norm());
    before = state;
  }
  return result;
}

TEST(ClutchAtRandom, GivesAHandNoMoreThanItPutIn) {
  int presses = 0;
  double felt = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Wandering result = wander(seed);
    EXPECT_LT(result.unpaid, 1e-5) << seed;
    EXPECT_LT(result.largest_step, kClutchSlew * 1e-3 + 0.05) << seed;
    presses += result.presses;
    felt = std::max(felt, result.felt);
  }
  EXPECT_GT(presses, 100);
  EXPECT_GT(felt, 3);
}

}  // namespace
}  // namespace palpate
