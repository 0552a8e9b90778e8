#include <gtest/gtest.h>

#include "servo/servo_rig.hpp"
#include "viewer/reports.hpp"

namespace palpate::viewer {
namespace {

/// A servo whose steps come when a test says.
struct Steps {
  Steps() : servo(device, (test::add_sheet(scene), scene)), source(servo, 0, {0, 0, 0}) {}

  void step(double dt) { servo.tick(time += dt); }
  StateMessage next() { return source.next(time, 0, false).value(); }

  Scene scene;
  test::FreeDevice device;
  Servo servo;
  StateReporter source;
  double time = 5;
};

TEST(StateReporter, SamplesFollowThoseOfTheMessageBefore) {
  Steps steps;
  for (int i = 0; i < 10; ++i) steps.step(1e-3);
  EXPECT_EQ(steps.next().forces.size(), 10u);
  for (int message = 0; message < 5; ++message) {
    const double before = steps.time;
    for (int i = 0; i < 16; ++i) steps.step(1e-3);
    steps.step(0.2e-3);                      // the last step was early ...
    if (message % 2 == 0) steps.step(4e-3);  // ... or late
    const StateMessage now = steps.next();
    const std::size_t n = now.forces.size();
    ASSERT_GE(n, 17u);
    EXPECT_NEAR(now.interval, (now.time - before) / static_cast<double>(n), 1e-8);
  }
}

TEST(StateReporter, WithoutANewStepTheLastOnesTimeIsTold) {
  Steps steps;
  steps.step(1e-3);
  steps.step(2e-3);
  EXPECT_FLOAT_EQ(steps.next().interval, 2e-3F);
  const StateMessage again = steps.next();
  EXPECT_FLOAT_EQ(again.interval, 2e-3F);
  EXPECT_TRUE(again.forces.empty());
}

// A step that was computed and is not shown yet does not count.
TEST(StateReporter, ForcesAreOfStepsUntilTheStatesOwn) {
  Steps steps;
  for (int i = 0; i < 5; ++i) steps.step(1e-3);
  EXPECT_EQ(steps.next().forces.size(), 5u);
  steps.servo.show();  // a force more than there are steps
  EXPECT_TRUE(steps.next().forces.empty());
  steps.step(1e-3);
  EXPECT_EQ(steps.next().forces.size(), 1u);
}

TEST(StateReporter, TellsTheOrientationOfDevicesThatKnowIt) {
  Steps steps;
  steps.device.state().orientation = Eigen::Quaterniond(0.6, 0, 0.8, 0);
  steps.step(1e-3);
  EXPECT_FALSE(steps.next().orientation);
  steps.device.info().has_orientation = true;
  EXPECT_EQ(steps.next().orientation.value().coeffs(), Eigen::Vector4f(0, 0.8F, 0, 0.6F));
}

TEST(StateReporter, TellsThePoseAndTheWrenchOfATool) {
  Scene scene;
  test::add_sheet(scene);
  test::FreeDevice device;
  ServoOptions options;
  options.tool = std::make_shared<const Tool>(Tool::gripper({0.01, 0.02, 0.03}, 0.005));
  options.workspace.scale = 2;
  Servo servo(device, scene, options);
  StateReporter source(servo, 0, {0, 0, 0});
  device.state().position.z() = 0.5;  // far above the sheet
  device.state().orientation = Eigen::Quaterniond(0.6, 0, 0.8, 0);
  device.state().gripper = 0.01;
  servo.tick(5);
  const StateMessage message = source.next(5, 0, false).value();
  EXPECT_NE(message.flags & state_flag::kTool, 0u);
  EXPECT_EQ(message.orientation.value().coeffs(), Eigen::Vector4f(0, 0.8F, 0, 0.6F));
  EXPECT_TRUE(message.tool.orientation.isApprox(Eigen::Quaternionf(0.6F, 0, 0.8F, 0), 1e-6F));
  EXPECT_FLOAT_EQ(message.tool.opening, 0.02F);
  EXPECT_FLOAT_EQ(message.tool.hand_opening, 0.02F);
  EXPECT_EQ(message.tool.torque, Eigen::Vector3f::Zero());
}

}  // namespace
}  // namespace palpate::viewer
