// A servo whose hand holds a tool that turns: forces and torques at the handle, and what a wrist
// may get.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "palpate/base/error.hpp"
#include "servo/servo_rig.hpp"
#include "servo/step_trace.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FreeDevice;

ServoOptions holding(const char* tool, ServoOptions options = {}) {
  options.tool = std::make_shared<const Tool>(Tool::from_text(tool, 4e-3));
  options.proxy.stiffness = 500;
  return options;
}

/// A hand with a wrist, one millisecond after the other.
class HandWithAWrist : public testing::Test {
 protected:
  // `turn`: of the tool about y when it is taken, rad.
  void hold(const ServoOptions& options, double turn = 0) {
    device_.state().orientation = Eigen::AngleAxisd(turn_ = turn, Vector3d::UnitY());
    device_.info().has_orientation = true;
    device_.info().maximum_force = 10;
    servo_ = std::make_unique<Servo>(device_, scene_, options);
  }

  // A step with the handle at a height, and the tool turned about y, rad. Adds up what the hand is
  // given by the force, and takes from it what the wrist, which feels no torque, would have to do.
  const ServoState& tick(double z, double turn) {
    const Vector3d before = device_.state().position;
    const double turned = turn_;
    device_.state().position = {-0.04, 0, z};
    device_.state().velocity = (device_.state().position - before) / 1e-3;
    device_.state().orientation = Eigen::AngleAxisd(turn_ = turn, Vector3d::UnitY());
    const Vector3d force = servo_->state().force;
    const ServoState& state = servo_->tick(now_ += 1e-3);
    given_ += 0.5 * (force + state.force).dot(device_.state().position - before);
    wrist_ += 0.5 * (torque_ + state.wrench.torque.y()) * (turn - turned);
    torque_ = state.wrench.torque.y();
    return state;
  }
  // From one height and turn to others.
  const ServoState& go(double z, double turn, int steps) {
    const double from = device_.state().position.z();
    const double turned = turn_;
    for (int i = 1; i < steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      tick(from + share * (z - from), turned + share * (turn - turned));
    }
    return tick(z, turn);
  }

  Scene scene_;
  Source& sheet_ = test::add_sheet(scene_);
  FreeDevice device_{Vector3d(-0.04, 0, 0.06)};
  std::unique_ptr<Servo> servo_;
  double now_ = 0;
  double turn_ = 0;
  double torque_ = 0;
  double given_ = 0;  // J
  double wrist_ = 0;
};

TEST_F(HandWithAWrist, PressesABoxOntoASheet) {
  hold(holding("box:20x30x10"));
  go(0.06, 0, 10);
  const ServoState& state = go(2e-3, 0, 600);
  for (int i = 0; i < 300; ++i) tick(2e-3, 0);
  EXPECT_NEAR(state.force.z(), 1.5, 5e-3);
  EXPECT_TRUE(state.contact.touching);
  EXPECT_NEAR(state.contact.normal.z(), 1, 1e-3);
  EXPECT_NEAR(state.tool.position.z(), 5e-3, 1e-4);
  EXPECT_NEAR(state.contact.proxy.z(), 5e-3, 1e-4);
  EXPECT_LT(state.wrench.torque.norm(), 1e-3);
  EXPECT_EQ(state.guard.fault, Guard::Fault::none);
}

// The tip of a stylus that lies along x is pressed down by the wrist alone: the handle rises, and
// with it the hand, which a force pushes up.
TEST_F(HandWithAWrist, ALeverLiftsTheHand) {
  hold(holding("capsule:80x2"), -M_PI / 2);
  go(0.02, -M_PI / 2, 200);
  const ServoState& state = go(0.02, -M_PI / 2 + 0.5, 300);
  EXPECT_TRUE(state.contact.touching);
  EXPECT_GT(state.force.z(), 0.2);
  EXPECT_GT(std::abs(state.wrench.torque.y()), 1e-3);
}

// A wrist that saws over a sheet at 3 Hz: the force gives the hand what the wrist would have had to
// do against the torque, and no more. The guard's ledger knows that, and lets it pass.
TEST_F(HandWithAWrist, ThatSawsIsGivenNoMoreThanItWouldDo) {
  hold(holding("capsule:80x2"), -M_PI / 2);
  go(0.03, -M_PI / 2, 200);
  double height = 0.03;
  double speed = 0;
  given_ = wrist_ = 0;
  double highest = -1;
  for (int i = 0; i < 6000; ++i) {
    const double turn = -M_PI / 2 + 0.5 * std::sin(2 * M_PI * 3 * 1e-3 * i);
    // 0.1 kg that weighs 0.5 N, with a damper of 1 N s/m.
    const double force = servo_->state().force.z();
    speed += 1e-3 * (force - 0.5 - 1.0 * speed) / 0.1;
    height += 1e-3 * speed;
    const ServoState& state = tick(height, turn);
    highest = std::max(highest, state.guard.energy);
  }
  EXPECT_GT(given_, 0.02);
  EXPECT_LE(given_ + wrist_, 1e-3);
  EXPECT_LT(highest, 2e-3);
  EXPECT_EQ(servo_->state().guard.fault, Guard::Fault::none);
}

TEST_F(HandWithAWrist, TakesTheHandsStiffnessAndFieldWhileItRuns) {
  hold(holding("ball:4", test::first_links()));
  go(0.06, 0, 10);
  go(1e-3, 0, 300);
  ContactSettings contact = servo_->contact();
  contact.stiffness = 250;
  servo_->set_contact(contact);
  go(1e-3, 0, 300);
  EXPECT_NEAR(servo_->state().force.z(), 250 * 3e-3, 0.02);
  servo_->set_field({.kind = FieldOptions::Kind::metaball});
  go(1e-3, 0, 300);
  EXPECT_TRUE(servo_->state().contact.touching);
  EXPECT_THROW(servo_->set_field({.tool_radius = 1e-3}), Error);
}

TEST_F(HandWithAWrist, RestsWhereItIsWhileTheClutchIsHeld) {
  ServoOptions options = holding("box:20x30x10");
  options.clutch_button = 0;
  hold(options);
  go(0.06, 0, 10);
  go(3e-3, 0, 300);
  device_.state().buttons = 1;
  const ServoState& held = go(-0.04, 0, 300);
  EXPECT_NEAR(held.tool.position.z(), 5e-3, 1e-4);
  EXPECT_LT(held.force.norm(), 1e-6);
  device_.state().buttons = 0;
  EXPECT_LT(go(-0.039, 0, 10).force.norm(), 0.05);
}

// A box whose corner the wrist turns into the sheet, on a device with motors for that.
class HandThatFeelsTorque : public HandWithAWrist {
 protected:
  void hold_box(double maximum_torque, ServoOptions options = test::first_links()) {
    device_.info().maximum_torque = maximum_torque;
    options.gyration = 0.03;
    hold(holding("box:20x30x10", options));
    go(0.06, 0, 10);
  }
  const ServoState& press() { return go(3e-3, 0.2, 600); }
};

TEST_F(HandThatFeelsTorque, GetsTheToolsTorque) {
  hold_box(1);
  const ServoState& state = press();
  EXPECT_GT(state.torque.norm(), 5e-3);
  EXPECT_LT((state.torque - state.wrench.torque).norm(), 1e-9);
  EXPECT_EQ(device_.wrench().force, state.force);
  EXPECT_EQ(device_.wrench().torque, state.torque);
  EXPECT_EQ(state.contact.drift, Vector3d::Zero());
}

TEST_F(HandThatFeelsTorque, GetsNoMoreThanItHolds) {
  hold_box(5e-3);
  const ServoState& state = press();
  EXPECT_GT(state.wrench.torque.norm(), 5e-3);
  EXPECT_NEAR(state.torque.norm(), 4e-3, 1e-9);
  EXPECT_TRUE(has(state.guard.notes, GuardNote::clamped));
}

TEST_F(HandThatFeelsTorque, LosesItWhilePausedOrSilentAndAtAFault) {
  hold_box(1);
  press();
  const auto is_free = [this](int steps) {
    for (int i = 0; i < steps; ++i) tick(3e-3, 0.2);
    return device_.wrench().torque.norm() + device_.wrench().force.norm() < 1e-9;
  };
  servo_->pause(true);
  EXPECT_FALSE(is_free(1));
  EXPECT_TRUE(is_free(30));
  servo_->pause(false);
  EXPECT_FALSE(is_free(30));
  device_.state().status = DeviceState::Status::silent;
  EXPECT_TRUE(is_free(30));
  device_.state().status = DeviceState::Status::ok;
  EXPECT_FALSE(is_free(30));
  device_.state().orientation.x() = std::nan("");
  servo_->tick(now_ += 1e-3);
  EXPECT_EQ(device_.wrench().torque, Vector3d::Zero());
  EXPECT_EQ(device_.wrench().force, Vector3d::Zero());
  EXPECT_EQ(servo_->state().guard.fault, Guard::Fault::proxy);
  device_.state().orientation = Eigen::AngleAxisd(0.2, Vector3d::UnitY());
  EXPECT_TRUE(is_free(30));
  servo_->reset();
  is_free(1);
  EXPECT_EQ(servo_->state().guard.fault, Guard::Fault::none);
}

TEST_F(HandThatFeelsTorque, LosesItWhileTheClutchIsHeld) {
  ServoOptions options = test::first_links();
  options.clutch_button = 0;
  hold_box(1, options);
  press();
  device_.state().buttons = 1;
  for (int i = 0; i < 100; ++i) tick(3e-3, 0.2);
  EXPECT_EQ(device_.wrench().torque, Vector3d::Zero());
}

// A magnified hand has longer levers in the world than at the hand.
TEST_F(HandThatFeelsTorque, GetsItSmallerWhereItIsMagnified) {
  ServoOptions options = test::first_links();
  options.workspace.scale = 2;
  options.workspace.T_world_device.translation().x() = 0.04;
  hold_box(1, options);
  const ServoState& state = go(1.5e-3, 0.2, 600);
  EXPECT_GT(state.torque.norm(), 5e-3);
  EXPECT_LT((2 * device_.wrench().torque - state.torque).norm(), 1e-12);
}

// The gyration is lowered to where turns are passive, but not below 10 mm; then the stiffness is.
TEST_F(HandThatFeelsTorque, HasAGyrationWithWhichTurnsArePassive) {
  device_.info().maximum_torque = 1;
  device_.info().damping = 2;
  ServoOptions options = holding("capsule:80x2");
  options.guard.damping = 0;
  hold(options);
  const double pace = 0.8 * 2 / 3e-3;  // N/m for 1 N s/m: a step of 1 ms, and one of delay
  const auto limit_of = [&] { return pace * device_.info().angular_damping / 1e-4; };
  EXPECT_NEAR(servo_->options().gyration, 0.01, 1e-12);
  EXPECT_EQ(servo_->stiffness_limit(), 0);
  device_.info().angular_damping = 5e-5;
  hold(options);
  EXPECT_NEAR(servo_->options().gyration, 0.01, 1e-12);
  EXPECT_NEAR(servo_->stiffness_limit(), limit_of(), 1e-9);
  device_.info().angular_damping = 5e-4;
  hold(options);
  EXPECT_NEAR(servo_->options().gyration, std::sqrt(pace * 5e-4 / 500), 1e-12);
  EXPECT_NEAR(servo_->stiffness_limit(), 500, 1e-9);
  device_.info().angular_damping = 5e-2;
  hold(options);
  EXPECT_NEAR(servo_->options().gyration, 0.041, 2e-3);  // the tool's: half of its extent
  EXPECT_NEAR(servo_->stiffness_limit(), 2 * pace, 1e-9);
  device_.info().angular_damping = 0;
  options.guard.damping = 1;  // holds 500 N/m by itself, whatever the gyration
  hold(options);
  EXPECT_NEAR(servo_->options().gyration, 0.041, 2e-3);
  options.gyration = 0.02;
  hold(options);
  EXPECT_EQ(servo_->options().gyration, 0.02);
}

TEST_F(HandWithAWrist, DoesItsStepsAgainFromTheirTraces) {
  StepTraces traces(1024);
  ServoOptions options = holding("box:20x30x10");
  options.traces = &traces;
  hold(options, 0.3);
  go(0.06, 0.3, 10);
  go(3e-3, 0.1, 300);
  go(2e-3, -0.4, 300);
  options.traces = nullptr;
  Servo again(device_, scene_, options);
  SceneField of_a_point(scene_);
  of_a_point.update_from(now_, Vector3d::Zero(), Vector3d::Zero());
  double torque = 0;
  int steps = 0;
  for (; const StepTrace* const trace = traces.front(); traces.drop(), ++steps) {
    const ServoState& before = trace->state;
    const ServoState& state = again.step(trace->input.device, before.time);
    ASSERT_EQ(state.force, before.force) << before.step;
    ASSERT_EQ(state.wrench.torque, before.wrench.torque) << before.step;
    ASSERT_EQ(state.tool.orientation.coeffs(), before.tool.orientation.coeffs()) << before.step;
    ASSERT_EQ(trace->input.found.publications, of_a_point.found().publications);
    ASSERT_EQ(trace->input.found.least_radii, of_a_point.found().least_radii);
    torque = std::max(torque, before.wrench.torque.norm());
  }
  EXPECT_EQ(steps, 610);
  EXPECT_GT(torque, 1e-3);
}

TEST_F(HandWithAWrist, RefusesOptionsOfAPoint) {
  ServoOptions options = holding("ball:4");
  options.field.tool_radius = 1e-3;
  EXPECT_THROW(Servo(device_, scene_, options), Error);
}

}  // namespace
}  // namespace palpate
