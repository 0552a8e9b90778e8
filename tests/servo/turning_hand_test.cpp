// Simulated hands that turn a tool on a sheet, with motors in the wrist and without: what they are
// given, and whether they rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "servo/turning_rig.hpp"

namespace palpate {
namespace {

using test::held_at;
using test::smooth_device;
using test::TurningHand;

constexpr double kStrongWrist = 0.5;  // N m: holds all torques here
constexpr double kWeakWrist = 0.02;   // N m: holds a quarter of them
constexpr const char* kStick = "capsule:80x2";

// A stick that lies along x, its handle 30 mm up, in a fist that saws by 0.5 rad at 3 Hz.
TurningHand sawing(double maximum_torque) {
  SimulatedDeviceOptions device = smooth_device(maximum_torque);
  device.wrist->hand.stiffness = 2;
  device.wrist->hand.maximum_torque = 2;
  return {device, {}, kStick, [](double time) {
            const double share = std::min(1.0, 2 * time);
            return held_at({-0.04, 0, 0.08 - 0.05 * share},
                           -M_PI / 2 + 0.5 * share * std::sin(2 * M_PI * 3 * time));
          }};
}

// The handle is lifted by what the wrist does, without feeling it.
TEST(TurningHand, ThatSawsWithoutMotorsIsGivenWhatItsWristDoes) {
  TurningHand hand = sawing(0);
  hand.run(20'000);
  EXPECT_GT(hand.given(), 0.05);
  EXPECT_LE(hand.given() - hand.by_surface(), 0);
  EXPECT_EQ(hand.servo().state().guard.counts.braked, 0u);
  EXPECT_EQ(hand.servo().state().torque.norm(), 0);
}

// The same with a torque that is felt: now nothing is given at all.
TEST(TurningHand, ThatSawsWithMotorsIsGivenNothing) {
  TurningHand hand = sawing(kStrongWrist);
  double largest = 0;
  for (int i = 0; i < 20'000; ++i) largest = std::max(largest, hand.step().torque.norm());
  EXPECT_GT(largest, 0.03);
  EXPECT_LE(hand.given(), 0);
  EXPECT_EQ(hand.by_surface(), 0);
  EXPECT_EQ(hand.servo().state().guard.counts.braked, 0u);
}

// Motors that hold less than they are to: what the force gives is braked.
TEST(TurningHand, ThatSawsWithWeakMotorsIsBraked) {
  TurningHand hand = sawing(kWeakWrist);
  double largest = 0;
  for (int i = 0; i < 20'000; ++i) largest = std::max(largest, hand.step().torque.norm());
  EXPECT_NEAR(largest, Servo::kForceShare * kWeakWrist, 1e-6);
  EXPECT_LE(hand.given(), 1e-3);
  EXPECT_GT(hand.servo().state().guard.counts.braked, 100u);
}

// A wrist that keeps still while the hand slides, presses and lifts: a third of a minute.
void expect_no_gift_to_a_still_wrist(double maximum_torque) {
  TurningHand hand(smooth_device(maximum_torque), {}, kStick, [](double t) {
    const double height = 0.043 + 0.1 * std::max(0.0, 1 - t) + 0.01 * std::cos(7 * t);
    return held_at({-0.02 + 0.02 * std::sin(3 * t), 0.02 * std::cos(2 * t), height}, -1);
  });
  double highest = 0;
  for (int i = 0; i < 20'000; ++i) {
    hand.step();
    highest = std::max(highest, hand.given());
  }
  EXPECT_LE(highest, 1e-3 / 3);
  EXPECT_GT(hand.touching(), 5000);
  EXPECT_LT(hand.touching(), 15'000);
}

TEST(TurningHand, ThatKeepsStillIsGivenNothingWithoutMotors) {
  expect_no_gift_to_a_still_wrist(0);
}

TEST(TurningHand, ThatKeepsStillIsGivenNothingWithMotors) {
  expect_no_gift_to_a_still_wrist(kStrongWrist);
}

// Swing of height and torque at rest, m and N m.
struct Swing {
  double height = 0;
  double torque = 0;
};

// A tool that is pressed down by a hand of springs alone, on a device of 0.1 kg and 5e-5 kg m2 with
// a tick of delay: damped so that 500 N/m are this share of what is passive, in turns as well.
Swing rest(const char* tool, double turn, double share) {
  constexpr double kGyrationHere = 0.03;  // m
  SimulatedDeviceOptions device = smooth_device(kStrongWrist);
  device.damping = 500 * (0.5e-3 + 1e-3) / share;
  device.hand = {.stiffness = 20, .damping = 0, .maximum_force = 8};
  device.wrist->inertia.setConstant(5e-5);
  device.wrist->damping = device.damping * kGyrationHere * kGyrationHere;
  device.wrist->hand = {.stiffness = 0.02, .damping = 0, .maximum_torque = 1};
  ServoOptions options;
  options.gyration = kGyrationHere;
  options.guard.stiffness_share = 10;  // what is not passive is asked for
  options.guard.damping = 0;
  options.guard.soft_start = 0;
  options.guard.passivity.on = false;
  TurningHand hand(device, options, tool, [&](double t) {
    return held_at({-0.03, 0, 0.03 - 0.06 * std::min(1.0, t)}, turn);
  });
  hand.run(9000);
  double low = 1;
  double high = -1;
  double least = 1;
  double most = -1;
  for (int i = 0; i < 1000; ++i) {
    const ServoState& state = hand.step();
    low = std::min(low, state.hip.z());
    high = std::max(high, state.hip.z());
    least = std::min(least, state.torque.y());
    most = std::max(most, state.torque.y());
  }
  return {high - low, most - least};
}

void expect_rest_below_the_bound(const char* tool, double turn) {
  for (const double share : {0.5, 0.8}) {
    const Swing swing = rest(tool, turn, share);
    EXPECT_LT(swing.height, 1e-6) << share;
    EXPECT_LT(swing.torque, 1e-5) << share;
  }
  const Swing beyond = rest(tool, turn, 2);
  EXPECT_GT(beyond.height, 1e-4);
  EXPECT_GT(beyond.torque, 1e-4);
}

TEST(TurningHand, RestsWithABoxUpToThePassiveBoundAndShakesBeyond) {
  expect_rest_below_the_bound("box:20x30x10", 0);
}

TEST(TurningHand, RestsWithAStickUpToThePassiveBoundAndShakesBeyond) {
  expect_rest_below_the_bound(kStick, -1.3);
}

}  // namespace
}  // namespace palpate
