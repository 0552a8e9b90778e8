// The real-time contract of Servo::tick: field, proxy, guard, and what it shows to others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "realtime/watch.hpp"
#include "servo/servo_rig.hpp"
#include "servo/step_trace.hpp"

namespace palpate::realtime {
namespace {

using Eigen::Vector3d;
using test::FreeDevice;

class ServoTick : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_trap_system_calls()) {
      GTEST_SKIP() << "this kernel has no Syscall User Dispatch (Linux 5.11 on x86-64)";
    }
    source_ = &test::add_sheet(scene_);
    device_.info().maximum_force = 2;
    ServoOptions options;
    options.guard.soft_start = 0.02;  // every link is at work
    options.guard.slew = 10;
    options.clutch_button = 0;
    options.traces = &traces_;
    servo_ = std::make_unique<Servo>(device_, scene_, options);
  }

  // A watched step with the hand at `z`, `dt` after the last one.
  const ServoState& tick(double z, double dt = 1e-3) {
    device_.state().position = {0.01 * std::sin(10 * now_), 0.3e-3, z};
    now_ += dt;
    Watch watch;
    const ServoState& state = servo_->tick(now_);
    const Findings found = watch.stop();
    EXPECT_EQ(found.total(), 0) << found << "at step " << state.step;
    return state;
  }

  // Down to 6 mm under the sheet and up again, in 200 steps.
  void press() {
    for (int i = 0; i < 200; ++i) tick(4e-3 - 10e-3 * std::sin(i * M_PI / 200));
  }

  Scene scene_;
  Source* source_ = nullptr;
  FreeDevice device_{{0, 0, 5e-3}};
  StepTraces traces_{256};  // nobody takes them: there is room for some steps
  std::unique_ptr<Servo> servo_;
  double now_ = 0;
};

TEST_F(ServoTick, KeepsTheContractWithAToolThatIsTraced) {
  ServoOptions options = servo_->options();
  options.tool = std::make_shared<const Tool>(Tool::box({8e-3, 12e-3, 4e-3}, 2e-3));
  StepTraces traces(1024);
  options.traces = &traces;
  servo_ = std::make_unique<Servo>(device_, scene_, options);
  double torque = 0;
  for (int i = 0; i < 200; ++i) {
    torque = std::max(torque, tick(4e-3 - 10e-3 * std::sin(i * M_PI / 200)).wrench.torque.norm());
  }
  EXPECT_GT(torque, 0);
  EXPECT_EQ(traces.dropped(), 0u);
  servo_.reset();  // before the traces that it puts steps into
}

TEST_F(ServoTick, KeepsTheContractInContactAndAtTheClamp) {
  press();
  EXPECT_GT(servo_->state().guard.counts.clamped, 10u);
}

TEST_F(ServoTick, KeepsTheContractWhileSnapshotsChangeAndVanish) {
  for (int i = 0; i < 400; ++i) {
    if (i % 33 == 0) source_->publish(test::still(test::plane(1e-3 * (i % 5)), now_ + 2e-3));
    if (i == 250) source_->publish(std::make_unique<const Snapshot>());
    if (i == 350) source_->publish(nullptr);
    tick(i < 20 ? 6e-3 - 5e-4 * i : -4e-3);
  }
  EXPECT_GT(servo_->state().guard.counts.slewed, 0u);
}

TEST_F(ServoTick, KeepsTheContractWhileTheClutchIsHeldAndLetGo) {
  int clutched = 0;
  for (int i = 0; i < 1000; ++i) {
    device_.state().buttons = i % 90 < 40 ? 0 : 1;
    device_.state().orientation = Eigen::AngleAxisd(0.01 * i, Vector3d::UnitX());
    if (i % 200 == 199) servo_->reset();
    if (i % 50 == 0) source_->publish(test::still(test::plane(1e-3 * (i % 3)), now_ + 2e-3));
    clutched += tick(4e-3 - 10e-3 * std::sin(i * M_PI / 60)).clutched ? 1 : 0;
  }
  EXPECT_GT(clutched, 400);
}

TEST_F(ServoTick, KeepsTheContractOnFaultsGapsAndReset) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), 1e300}) {
    press();
    tick(-2e-3, 0.1);  // the watchdog's
    tick(bad);
    tick(-2e-3);
    EXPECT_NE(servo_->state().guard.fault, Guard::Fault::none);
    servo_->reset();
    tick(5e-3);
    EXPECT_EQ(servo_->state().guard.fault, Guard::Fault::none);
  }
  tick(0, nan);
  now_ = 10;
  servo_->reset();
  press();
  device_.state().status = DeviceState::Status::failed;
  tick(-2e-3);
  EXPECT_EQ(servo_->state().guard.fault, Guard::Fault::device);
}

TEST_F(ServoTick, KeepsTheContractWhileOthersWatchAndChangeIt) {
  std::jthread others([&](const std::stop_token& stop) {
    for (int i = 0; !stop.stop_requested(); ++i) {
      static_cast<void>(servo_->state());
      static_cast<void>(servo_->durations());
      servo_->set_contact({.stiffness = 200.0 + i % 100, .texture = {.amplitude = 1e-5 * (i % 3)}});
      servo_->set_field(
          {.kind = i % 200 < 100 ? FieldOptions::Kind::balanced : FieldOptions::Kind::metaball});
      servo_->pause(i % 50 == 0);
    }
  });
  press();
  press();
}

// Torque and grip, too: every link on all axes, until a fault and after it.
TEST_F(ServoTick, KeepsTheContractWithAGripperThatIsFelt) {
  device_.info().maximum_torque = 0.02;
  device_.info().maximum_grip = 0.2;
  ServoOptions options;
  options.guard.soft_start = 0.02;
  options.guard.slew = 10;
  options.tool = std::make_shared<const Tool>(Tool::gripper({6e-3, 12e-3, 30e-3}, 4e-3));
  servo_ = std::make_unique<Servo>(device_, scene_, options);
  double torque = 0;
  for (int i = 0; i < 3000; ++i) {
    const double turn = 0.8 + 0.5 * std::sin(0.01 * i);
    device_.state().orientation = Eigen::AngleAxisd(turn, Vector3d::UnitY());
    device_.state().angular_velocity.y() = 5 * std::cos(0.01 * i);
    device_.state().gripper = 0.01 + 0.01 * std::sin(0.02 * i);
    if (i == 1500) device_.state().orientation.x() = std::numeric_limits<double>::quiet_NaN();
    if (i == 1600) servo_->reset();
    servo_->pause(i % 500 > 450);
    const ServoState& state =
        tick(i < 50 ? 0.06 : 0.02 - 0.005 * std::sin(0.007 * i), i % 400 == 399 ? 9e-3 : 1e-3);
    torque = std::max(torque, state.torque.norm());
  }
  const Guard::State::Counts& counts = servo_->state().guard.counts;
  EXPECT_GT(torque, 1e-3);
  EXPECT_GT(counts.clamped, 10u);
  EXPECT_GT(counts.slewed, 10u);
  EXPECT_GT(counts.silences, 3u);
  EXPECT_EQ(counts.faults, 1u);
}

}  // namespace
}  // namespace palpate::realtime
