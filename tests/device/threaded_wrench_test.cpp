// What of a torque and a grip goes through a threaded device to its hardware.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "device/fake_hardware.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FakeDriver;
using test::FakeHardware;
using test::MovedClock;

class ThreadedWrench : public testing::Test {
 protected:
  ThreadedWrench() {
    for (int i = 0; i < 3; ++i) (void)exchange({});  // the first positions count as silent
  }

  // What the hardware is told where the servo writes `wrench`.
  Wrench exchange(const Wrench& wrench) {
    device_.service();
    (void)device_.read();
    device_.write_wrench(wrench);
    device_.service();
    return hardware_.told();
  }

  MovedClock clock_;
  FakeHardware hardware_{clock_};
  ThreadedDevice device_{
      [this] { return std::make_unique<FakeDriver>(hardware_); }, clock_, {.threaded = false}};
};

TEST_F(ThreadedWrench, PassesWhatTheHardwareBears) {
  const Wrench told = exchange({{1, 0, 0}, {0, 0.05, 0}, 2});
  EXPECT_EQ(told.force, Vector3d(1, 0, 0));
  EXPECT_EQ(told.torque, Vector3d(0, 0.05, 0));
  EXPECT_EQ(told.grip, 2);
}

TEST_F(ThreadedWrench, IsShortenedPartByPart) {
  const Wrench told = exchange({{1, 0, 0}, {0, 3, 4}, -9});
  EXPECT_EQ(told.force, Vector3d(1, 0, 0));
  EXPECT_TRUE(told.torque.isApprox(Vector3d(0, 0.06, 0.08)));
  EXPECT_EQ(told.grip, -3);
}

TEST_F(ThreadedWrench, EndsWithAForceAlone) {
  (void)exchange({{1, 0, 0}, {0, 0.05, 0}, 2});
  device_.write({1, 0, 0});
  device_.service();
  EXPECT_EQ(hardware_.told().torque, Vector3d::Zero());
  EXPECT_EQ(hardware_.told().grip, 0);
}

TEST_F(ThreadedWrench, EndsWhereNobodyWrites) {
  (void)exchange({{1, 0, 0}, {0, 0.05, 0}, 2});
  clock_.wait_until(clock_.now() + 6e-3);
  device_.service();
  EXPECT_EQ(hardware_.told().torque, Vector3d::Zero());
}

TEST_F(ThreadedWrench, ThatIsNotFiniteIsAFailure) {
  const Wrench told = exchange({.grip = std::nan("")});
  EXPECT_EQ(told.grip, 0);
  EXPECT_EQ(device_.read().status, DeviceState::Status::failed);
}

}  // namespace
}  // namespace palpate
