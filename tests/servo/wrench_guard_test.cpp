// The guard of force, torque and grip: its links on all axes at once.
#include "servo/wrench_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "servo/guard_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kWrenchStep = 1e-3;                    // s
constexpr double kGuardedGyration = 0.02;               // m
constexpr double kPushedStiffness = 500;                // N/m, as of test::pushed()
constexpr double kHeldTorque = 0.1;                     // N m that the device holds
constexpr double kHeldGrip = 5;                         // N that it holds
constexpr double kTorqueSlew = 300 * kGuardedGyration;  // N m/s
const double kNoNumber = std::numeric_limits<double>::quiet_NaN();

DeviceInfo strong() {
  DeviceInfo device;
  device.maximum_force = 10;
  device.maximum_torque = kHeldTorque;
  device.maximum_grip = kHeldGrip;
  return device;
}

// A guard with one hand, which may turn about y.
class GuardedHand {
 public:
  explicit GuardedHand(const GuardOptions& options = test::plain(8),
                       const DeviceInfo& device = strong(), double scale = 1)
      : guard_(options, device, scale, kGuardedGyration) {}

  // A millisecond's step in which the hand feels `wrench`.
  Wrench feel(const Wrench& wrench, double turn = 0, double opening = 0) {
    return feel(test::pushed(wrench.force), wrench, turn, opening);
  }
  Wrench feel(const Guard::Input& input, const Wrench& wrench, double turn = 0,
              double opening = 0) {
    const double rate = (turn - turn_) / kWrenchStep;
    turn_ = turn;
    WrenchGuard::Turn all{wrench, {}, rate * Vector3d::UnitY()};
    all.hand.orientation = Eigen::AngleAxisd(turn, Vector3d::UnitY());
    all.hand.opening = opening;
    return guard_.pass(input, all);
  }
  [[nodiscard]] const Guard::State& state() const { return guard_.state(); }
  void reset() { guard_.reset(); }

 private:
  WrenchGuard guard_;
  double turn_ = 0;
};

Wrench twisted(double torque, double force = 0, double grip = 0) {
  return {Vector3d(0, 0, force), Vector3d(0, torque, 0), grip};
}

TEST(WrenchGuard, LetsASpringPassThatTheHandTurns) {
  GuardedHand hand;
  const double stiffness = kPushedStiffness * kGuardedGyration * kGuardedGyration;
  for (int i = 0; i < 300; ++i) {
    const double turn = 0.3 * std::sin(0.02 * i);
    const Wrench felt = hand.feel(twisted(-stiffness * turn), turn);
    ASSERT_NEAR(felt.torque.y(), -stiffness * turn, 1e-12);
    ASSERT_EQ(hand.state().notes, GuardNote::none) << i;
  }
}

TEST(WrenchGuard, LetsAGripPassThatTheFingersClose) {
  GuardedHand hand;
  for (int i = 0; i < 40; ++i) {
    const double opening = 0.02 - 1e-4 * i;
    const double grip = kPushedStiffness * (0.02 - opening);
    ASSERT_NEAR(hand.feel(twisted(0, 0, grip), 0, opening).grip, grip, 1e-12);
    ASSERT_EQ(hand.state().notes, GuardNote::none) << i;
  }
}

// The limit is 300 N/s times the gyration.
TEST(WrenchGuard, SlewsATorqueThatTheHandDidNotMake) {
  GuardedHand hand;
  (void)hand.feel({});
  for (int i = 1; i <= 20; ++i) {
    const Wrench felt = hand.feel(twisted(0.05));
    EXPECT_NEAR(felt.torque.y(), std::min(kTorqueSlew * kWrenchStep * i, 0.05), 1e-12);
    EXPECT_EQ(has(hand.state().notes, GuardNote::slewed), kTorqueSlew * kWrenchStep * i < 0.05);
  }
}

TEST(WrenchGuard, HoldsWhatTheDeviceDoesPartByPart) {
  GuardedHand hand;
  Wrench felt;
  for (int i = 0; i < 2000; ++i) {
    felt = hand.feel(twisted(1, 3, -20));
    ASSERT_LE(felt.torque.norm(), 0.8 * kHeldTorque * (1 + 1e-15));
    ASSERT_GE(felt.grip, -0.8 * kHeldGrip);
  }
  EXPECT_NEAR(felt.torque.y(), 0.8 * kHeldTorque, 1e-12);
  EXPECT_NEAR(felt.grip, -0.8 * kHeldGrip, 1e-12);
  EXPECT_NEAR(felt.force.z(), 3, 1e-12);
  EXPECT_TRUE(has(hand.state().notes, GuardNote::clamped));
}

TEST(WrenchGuard, LeavesOutWhatTheDeviceDoesNotRender) {
  DeviceInfo device = strong();
  device.maximum_grip = 0;
  GuardedHand torques(test::plain(8), device);
  device = strong();
  device.maximum_torque = 0;
  GuardedHand grips(test::plain(8), device);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(torques.feel(twisted(0.05, 2, 3)).grip, 0);
    EXPECT_EQ(grips.feel(twisted(0.05, 2, 3)).torque, Vector3d::Zero());
  }
  EXPECT_NEAR(torques.feel(twisted(0.05, 2, 3)).torque.y(), 0.05, 1e-12);
  EXPECT_NEAR(grips.feel(twisted(0.05, 2, 3)).grip, 3, 1e-12);
  EXPECT_FALSE(has(torques.state().notes, GuardNote::clamped));
}

TEST(WrenchGuard, FadesTorqueAsForceWhileNothingIsToBeFelt) {
  GuardedHand hand;
  for (int i = 0; i < 100; ++i) (void)hand.feel(twisted(0.05, 2, 3));
  Guard::Input unfelt = test::pushed({0, 0, 2});
  unfelt.felt = false;
  const double size = std::hypot(0.05 / kGuardedGyration, 2, 3);  // N, in the metric
  for (int i = 1; i <= 20; ++i) {
    const Wrench felt = hand.feel(unfelt, twisted(0.05, 2, 3));
    const double left = std::max(0.0, 1 - 300 * kWrenchStep * i / size);
    EXPECT_NEAR(felt.torque.y(), left * 0.05, 1e-12);
    EXPECT_NEAR(felt.force.z(), left * 2, 1e-12);
    EXPECT_NEAR(felt.grip, left * 3, 1e-12);
  }
}

TEST(WrenchGuard, IsZeroAtOnceAfterASilence) {
  GuardedHand hand;
  for (int i = 0; i < 100; ++i) (void)hand.feel(twisted(0.05, 2, 3));
  Guard::Input late = test::pushed({0, 0, 2});
  late.dt = 6e-3;
  const Wrench felt = hand.feel(late, twisted(0.05, 2, 3));
  EXPECT_EQ(felt.force, Vector3d::Zero());
  EXPECT_EQ(felt.torque, Vector3d::Zero());
  EXPECT_EQ(felt.grip, 0);
  EXPECT_EQ(hand.state().notes, GuardNote::silence);
}

TEST(WrenchGuard, HoldsZeroUntilResetWhenAnythingIsNotFinite) {
  const Wrench good = twisted(0.05, 2, 3);
  Guard::Input failed = test::pushed({0, 0, 2});
  failed.fault = Guard::Fault::device;
  const auto breakers = {+[](GuardedHand& hand, const Wrench&, const Guard::Input&) {
                           return hand.feel(twisted(kNoNumber, 2, 3));
                         },
                         +[](GuardedHand& hand, const Wrench&, const Guard::Input&) {
                           return hand.feel(twisted(0.05, 2, kNoNumber));
                         },
                         +[](GuardedHand& hand, const Wrench& wrench, const Guard::Input&) {
                           return hand.feel(wrench, kNoNumber);
                         },
                         +[](GuardedHand& hand, const Wrench& wrench, const Guard::Input& input) {
                           return hand.feel(input, wrench);
                         }};
  for (const auto& broken : breakers) {
    GuardedHand hand;
    for (int i = 0; i < 100; ++i) (void)hand.feel(good);
    for (int i = 0; i < 3; ++i) {
      const Wrench felt = i == 0 ? broken(hand, good, failed) : hand.feel(good);
      EXPECT_EQ(felt.force, Vector3d::Zero());
      EXPECT_EQ(felt.torque, Vector3d::Zero());
      EXPECT_EQ(felt.grip, 0);
      EXPECT_NE(hand.state().fault, Guard::Fault::none);
    }
    hand.reset();
    for (int i = 0; i < 100; ++i) (void)hand.feel(good);
    EXPECT_NEAR(hand.feel(good).torque.y(), 0.05, 1e-12);
  }
}

// Torque and grip that go with the hand's motion give it energy, each by itself; then a brake acts.
TEST(WrenchGuard, CountsWhatTorqueAndGripGive) {
  GuardOptions options = test::plain(8);
  options.passivity.on = true;
  options.passivity.delay = 0;
  DeviceInfo device = strong();
  device.inertia = 1e3;  // the brake is not bounded by it
  options.passivity.mass = 1e6;
  for (const bool turning : {true, false}) {
    GuardedHand hand(options, device);
    const Wrench pushing = turning ? twisted(0.05) : twisted(0, 0, 2);
    for (int i = 0; i < 100; ++i) (void)hand.feel(pushing);
    double given = 0;
    Wrench before = hand.feel(pushing);
    for (int i = 1; i <= 50; ++i) {
      const double way = 1e-3 * i;
      const Wrench felt =
          hand.feel(pushing, turning ? way : 0, turning ? 0 : kGuardedGyration * way);
      given += 1e-3 * (before.torque.y() + kGuardedGyration * before.grip);
      ASSERT_NEAR(hand.state().energy, given, 1e-9) << i;
      before = felt;
    }
    EXPECT_GT(hand.state().counts.braked, 40u);
    EXPECT_LT(given, 2e-4);  // without a brake 2.5 mJ
  }
}

TEST(WrenchGuard, DampsTurnsByTheSquareOfTheGyration) {
  GuardOptions options = test::plain(8);
  options.damping = 2;
  GuardedHand hand(options);
  Wrench felt;
  for (int i = 0; i < 200; ++i) felt = hand.feel(twisted(-0.05), 1e-3 * i);
  EXPECT_NEAR(felt.torque.y(), -0.05 - 2 * kGuardedGyration * kGuardedGyration * 1, 1e-9);
}

// What is magnified five times has levers five times as long.
TEST(WrenchGuard, HoldsTheTorqueOfAMagnifiedHand) {
  GuardedHand hand(test::plain(8), strong(), 5);
  Wrench felt;
  for (int i = 0; i < 3000; ++i) felt = hand.feel(twisted(9));
  const Workspace workspace{Eigen::Isometry3d::Identity(), 5};
  EXPECT_NEAR(workspace.wrench_to_device(felt).torque.y(), 0.8 * kHeldTorque, 1e-12);
}

}  // namespace
}  // namespace palpate
