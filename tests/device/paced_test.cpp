#include "palpate/device/paced.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "device/hand_clock.hpp"
#include "palpate/device/scripted.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::HandClock;

Trajectory straight(double duration) {
  return {{0, Vector3d::Zero()}, {duration, Vector3d(duration, 0, 0)}};
}

TEST(PacedDevice, IsTheDeviceItselfWhenReadOnTime) {
  SimulatedDevice one({}, straight(0.2));
  SimulatedDevice other({}, straight(0.2));
  HandClock clock;
  PacedDevice paced(one, clock);
  EXPECT_FALSE(paced.info().keeps_time);
  EXPECT_EQ(paced.info().rate, other.info().rate);
  for (int i = 0; i < 200; ++i) {
    clock.time = 1000 + 1e-3 * i + (i % 3) * 0.1e-3;  // a little late now and then
    const DeviceState seen = paced.read();
    const DeviceState expected = other.read();
    ASSERT_EQ(seen.time, expected.time) << i;
    ASSERT_EQ(seen.position, expected.position);
    ASSERT_EQ(seen.velocity, expected.velocity);
    const Vector3d force = -50 * seen.position;
    paced.write(force);
    other.write(force);
  }
  EXPECT_EQ(one.true_position(), other.true_position());
}

TEST(PacedDevice, GoesOnWhileNobodyReads) {
  SimulatedDevice device({}, straight(0.2));
  HandClock clock;
  PacedDevice paced(device, clock);
  static_cast<void>(paced.read());
  clock.time += 0.1;
  EXPECT_NEAR(paced.read().time, 0.1, 0.5e-3 + 1e-9);
  EXPECT_GT(device.true_position().x(), 0.05);
  const double before = paced.read().time;
  EXPECT_EQ(paced.read().time, before) << "no time went by";
}

TEST(PacedDevice, FallsBackBehindALongGapAndGoesOnFromThere) {
  SimulatedDevice device({.duration = 100.0});
  HandClock clock;
  PacedDevice paced(device, clock);
  static_cast<void>(paced.read());
  clock.time += 10;
  const double time = paced.read().time;
  EXPECT_NEAR(time, 1e-3 * PacedDevice::kMostSteps, 1e-9);
  clock.time += 0.05;
  EXPECT_NEAR(paced.read().time, time + 0.05, 1e-3);
}

TEST(PacedDevice, TellsWhenTheDeviceHasFinishedOrFailed) {
  ScriptedDevice device({{0, Vector3d::Zero()}, {1e-3, Vector3d::Zero()}});
  HandClock clock;
  PacedDevice paced(device, clock);
  EXPECT_EQ(paced.read().status, DeviceStatus::ok);
  clock.time += 1;
  EXPECT_EQ(paced.read().status, DeviceStatus::finished);

  SimulatedDevice broken;
  PacedDevice other(broken, clock);
  static_cast<void>(other.read());
  other.write(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  clock.time += 1;
  EXPECT_EQ(other.read().status, DeviceStatus::failed);
  EXPECT_FALSE(other.reason().empty());
}

}  // namespace
}  // namespace palpate
