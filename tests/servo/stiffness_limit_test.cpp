// No surface is felt stiffer than its device bears.
#include <gtest/gtest.h>

#include <limits>

#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using test::FreeDevice;

const Eigen::Vector3d kPressedHip(0.3e-3, 0.4e-3, -4e-3);  // m: 2 N at 500 N/m

TEST(StiffnessLimit, IsWhatTheDeviceBears) {
  Scene scene;
  test::add_sheet(scene);
  SimulatedDevice simulated;  // 0.5 N s/m, a step's delay; the damper adds 1 N s/m
  EXPECT_NEAR(Servo(simulated, scene).stiffness_limit(), 0.8 * 2 * 1.5 / 3e-3, 1e-9);
  FreeDevice device({0, 0, 5e-3});
  EXPECT_EQ(Servo(device, scene).stiffness_limit(), std::numeric_limits<double>::infinity())
      << "it renders no force";
  device.info().maximum_force = 10;
  EXPECT_NEAR(Servo(device, scene).stiffness_limit(), 0.8 * 2 * 1 / 3e-3, 1e-9)
      << "what is not known is taken as the worst";
  EXPECT_EQ(Servo(device, scene, {.guard = {.on = false}}).stiffness_limit(),
            std::numeric_limits<double>::infinity());
  device.info().maximum_stiffness = 300;
  ServoOptions options;
  options.workspace.scale = 2;
  options.guard.soft_start = 0;
  Servo servo(device, scene, options);
  EXPECT_NEAR(servo.stiffness_limit(), 150, 1e-9) << "the maker's, of magnified motion";
  servo.tick(0);
  device.state().position = 0.5 * kPressedHip;
  EXPECT_NEAR(servo.tick(1e-3).contact.stiffness, 150, 1e-9);
  EXPECT_TRUE(has(servo.state().guard.notes, GuardNote::softened));
  servo.set_contact({.stiffness = 100});
  for (int i = 2; i < 200; ++i) servo.tick(1e-3 * i);
  EXPECT_NEAR(servo.state().contact.stiffness, 100, 1);
  EXPECT_FALSE(has(servo.state().guard.notes, GuardNote::softened));
  servo.set_contact({.stiffness = 1000});
  for (int i = 200; i < 210; ++i) servo.tick(1e-3 * i);
  EXPECT_TRUE(has(servo.state().guard.notes, GuardNote::softened));
}

TEST(StiffnessLimit, AForceBelowZeroIsRefused) {
  Scene scene;
  FreeDevice device({0, 0, 5e-3});
  for (const double force : {-3.0, std::numeric_limits<double>::quiet_NaN()}) {
    device.info().maximum_force = force;
    EXPECT_THROW(Servo(device, scene), Error) << force;
  }
}

}  // namespace
}  // namespace palpate
