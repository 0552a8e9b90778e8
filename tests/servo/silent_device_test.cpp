// A device that is not heard for a while: no force, no fault, and a soft return.
#include <gtest/gtest.h>

#include "palpate/device/simulated.hpp"
#include "palpate/servo/servo.hpp"
#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FreeDevice;

constexpr double kSlew = 300;                    // N/s, the guard's
const Vector3d kFree(0.3e-3, 0.4e-3, 5e-3);      // m
const Vector3d kPressed(0.3e-3, 0.4e-3, -4e-3);  // m: 2 N at 500 N/m

class SilentDevice : public testing::Test {
 protected:
  const ServoState& tick(const Vector3d& position, DeviceState::Status status) {
    device_.state().position = position;
    device_.state().status = status;
    now_ += 1e-3;
    return servo_.tick(now_);
  }
  void tick(int times, const Vector3d& position, DeviceState::Status status) {
    for (int i = 0; i < times; ++i) tick(position, status);
  }

  Scene scene_;
  Source& sheet_ = test::add_sheet(scene_);
  FreeDevice device_{kFree};
  Servo servo_{device_, scene_, test::first_links()};
  double now_ = 1;
};

TEST_F(SilentDevice, ForceFadesAndComesBackAtTheGuardsRate) {
  tick(10, kFree, DeviceState::Status::ok);
  tick(10, kPressed, DeviceState::Status::ok);
  double force = servo_.state().force.norm();
  ASSERT_GT(force, 1);
  for (int i = 0; i < 20; ++i) {
    const double now = tick(kPressed, DeviceState::Status::silent).force.norm();
    ASSERT_GE(now, force - kSlew * 1.001e-3);
    force = now;
  }
  EXPECT_EQ(force, 0);
  EXPECT_EQ(servo_.state().guard.fault, Guard::Fault::none);
  for (int i = 0; i < 20; ++i) {
    const double now = tick(kPressed, DeviceState::Status::ok).force.norm();
    ASSERT_LE(now, force + kSlew * 1.001e-3);
    force = now;
  }
  EXPECT_GT(force, 1);
}

TEST_F(SilentDevice, ForceStaysAwayUntilTheHandIsLiftedWhereTheGuardStartsSoftly) {
  Servo servo(device_, scene_);
  const auto go = [&](int times, const Vector3d& position, DeviceState::Status status) {
    device_.state().position = position;
    device_.state().status = status;
    for (int i = 0; i < times; ++i) servo.tick(now_ += 1e-3);
    return servo.state().force.norm();
  };
  go(600, kFree, DeviceState::Status::ok);
  EXPECT_NEAR(go(500, kPressed, DeviceState::Status::ok), 2, 0.05);
  EXPECT_EQ(go(3000, kPressed, DeviceState::Status::silent), 0);
  EXPECT_LT(go(1000, kPressed, DeviceState::Status::ok), 0.2) << "the hand has not paid for more";
  EXPECT_TRUE(has(servo.state().guard.notes, GuardNote::starting));
  EXPECT_EQ(go(600, {0, 0, 15e-3}, DeviceState::Status::ok), 0);
  EXPECT_NEAR(go(500, kPressed, DeviceState::Status::ok), 2, 0.05);
}

TEST_F(SilentDevice, HandThatWasElsewhereMeanwhileIsNotStruck) {
  tick(10, kFree, DeviceState::Status::ok);
  tick(100, kFree, DeviceState::Status::silent);
  EXPECT_EQ(tick(kPressed, DeviceState::Status::silent).force.norm(), 0)
      << "heard again, elsewhere";
  EXPECT_LE(tick(kPressed, DeviceState::Status::ok).force.norm(), kSlew * 1.001e-3);
}

TEST_F(SilentDevice, ContactBeginsWhereTheFirstHandIsHeard) {
  const Vector3d below(0.3e-3, 0.4e-3, -8e-3);
  tick(10, kFree, DeviceState::Status::silent);  // nobody yet: that place is no hand's
  tick(below, DeviceState::Status::silent);
  tick(10, below, DeviceState::Status::ok);
  EXPECT_EQ(servo_.state().force.norm(), 0) << "it came from below";
  EXPECT_EQ(servo_.state().contact.proxy, below);
}

TEST_F(SilentDevice, IsReadOnByTheClockThatPacesIt) {
  class Time final : public Clock {
   public:
    [[nodiscard]] double now() const noexcept override { return time; }
    double time = 0;
  } clock;
  class Counted final : public Device {
   public:
    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] DeviceState read() noexcept override {
      DeviceState state;
      state.status = DeviceState::Status::silent;
      state.time = 1e-3 * reads++;
      return state;
    }
    void write(const Vector3d&) noexcept override {}
    [[nodiscard]] std::string reason() const override { return {}; }
    int reads = 0;

   private:
    DeviceInfo info_;
  } device;
  PacedDevice paced(device, clock);
  for (int i = 0; i < 50; ++i) {
    clock.time = 1e-3 * i;
    EXPECT_EQ(paced.read().status, DeviceState::Status::silent);
  }
  EXPECT_EQ(device.reads, 50);
}

}  // namespace
}  // namespace palpate
