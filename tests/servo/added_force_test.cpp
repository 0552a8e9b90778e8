#include <gtest/gtest.h>

#include <limits>

#include "palpate/base/error.hpp"
#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FreeDevice;

// At rest, far above the sheet.
struct Resting {
  Resting() : device({0, 0, 0.05}) {
    test::add_sheet(scene);
    servo.emplace(device, scene, options());
  }

  static ServoOptions options() {
    ServoOptions options = test::first_links();
    options.guard.slew = 1e6;
    options.guard.silence = std::numeric_limits<double>::infinity();  // steps are far apart
    return options;
  }

  Vector3d step(double time) { return servo->tick(time).force; }

  Scene scene;
  FreeDevice device;
  std::optional<Servo> servo;
};

TEST(AddedForce, IsFeltAndFadesInATenthOfASecond) {
  Resting hand;
  hand.step(0);
  hand.servo->add_force({0, 0, 2});
  EXPECT_EQ(hand.step(1e-3), Vector3d(0, 0, 2));
  EXPECT_NEAR(hand.step(51e-3).z(), 1, 1e-9);
  EXPECT_EQ(hand.step(101e-3), Vector3d::Zero());
  EXPECT_EQ(hand.step(1), Vector3d::Zero());
}

TEST(AddedForce, IsHeldByMessagesThatFollowOneAnother) {
  Resting hand;
  for (int i = 0; i < 100; ++i) {
    hand.servo->add_force({1, 0, 0});
    EXPECT_EQ(hand.step(0.01 * i).x(), 1);
  }
}

TEST(AddedForce, IsLimitedByTheGuardAsEveryForceIs) {
  Resting hand;
  ServoOptions options = Resting::options();
  options.guard.slew = 300;
  options.guard.maximum_force = 3;
  hand.servo.emplace(hand.device, hand.scene, options);
  hand.step(0);
  hand.servo->add_force({0, 0, 100});
  EXPECT_NEAR(hand.step(1e-3).norm(), 0.3, 1e-9);
  for (int i = 2; i < 40; ++i) {
    hand.servo->add_force({0, 0, 100});
    hand.step(1e-3 * i);
  }
  EXPECT_NEAR(hand.servo->state().force.norm(), 3, 1e-9);
}

TEST(AddedForce, HasToBeFinite) {
  Resting hand;
  EXPECT_THROW(hand.servo->add_force({0, std::numeric_limits<double>::quiet_NaN(), 0}), Error);
  EXPECT_EQ(hand.step(0), Vector3d::Zero());
}

}  // namespace
}  // namespace palpate
