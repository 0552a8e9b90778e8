#include <gtest/gtest.h>

#include <limits>

#include "device/hand_clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

Trajectory three_rows() {
  return {{0.5, {0, 0, 0}}, {0.6, {0.01, 0, 0}}, {0.65, {0.01, 0.02, 0}}};
}

TEST(ScriptedDevice, PlaysOneRowAStepThenIsFinished) {
  ScriptedDevice device(three_rows());
  const Trajectory rows = three_rows();
  for (const TrajectoryRow& row : rows) {
    const DeviceState state = device.read();
    EXPECT_EQ(state.status, DeviceState::Status::ok);
    EXPECT_EQ(state.time, row.time);
    EXPECT_EQ(state.position, row.position);
    device.write({0, 0, 1});
  }
  const DeviceState last = device.read();
  EXPECT_EQ(last.status, DeviceState::Status::finished);
  EXPECT_EQ(last.position, rows.back().position);
}

TEST(ScriptedDevice, HoldsAToolAsTheRowsSay) {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.1, Vector3d::UnitX()));
  Trajectory rows(2);
  rows[0].orientation = Eigen::Quaterniond::Identity();
  rows[0].opening = 0;
  rows[1].time = 0.5;
  rows[1].orientation = turned;
  rows[1].opening = 0.02;
  ScriptedDevice device(rows);
  EXPECT_TRUE(device.info().has_orientation && device.info().has_gripper);
  (void)device.read();
  const DeviceState state = device.read();
  EXPECT_EQ(state.orientation.coeffs(), turned.coeffs());
  EXPECT_LT((state.angular_velocity - Vector3d(0.2, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(state.gripper, 0.02);
  EXPECT_EQ(device.read().angular_velocity, Vector3d::Zero());
  EXPECT_FALSE(ScriptedDevice(three_rows()).info().has_orientation);
  rows[1].orientation = Eigen::Quaterniond(0, 0, 0, 0);
  EXPECT_THROW(ScriptedDevice{rows}, Error);
}

TEST(ScriptedDevice, VelocityIsFromTheRowBeforeOverUnevenTimes) {
  ScriptedDevice device(three_rows());
  EXPECT_EQ(device.read().velocity, Vector3d::Zero());
  EXPECT_LT((device.read().velocity - Vector3d(0.1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((device.read().velocity - Vector3d(0, 0.4, 0)).norm(), 1e-12);
}

TEST(ScriptedDevice, ForceThatIsNotFiniteIsLatchedWithAReason) {
  ScriptedDevice device(three_rows());
  (void)device.read();
  EXPECT_EQ(device.reason(), "");
  device.write({0, std::numeric_limits<double>::quiet_NaN(), 0});
  EXPECT_EQ(device.read().status, DeviceState::Status::failed);
  device.write({1, 0, 0});
  EXPECT_EQ(device.read().status, DeviceState::Status::failed);
  EXPECT_EQ(device.force(), Vector3d::Zero());
  EXPECT_NE(device.reason().find("0.5 s"), std::string::npos);
}

TEST(ScriptedDevice, RefusesWhatIsNoTrajectory) {
  EXPECT_THROW(ScriptedDevice({}), Error);
  EXPECT_THROW(ScriptedDevice({{0, {0, 0, 0}}, {0, {1, 0, 0}}}), Error);
  EXPECT_THROW(ScriptedDevice({{0, {0, 0, 0}}, {-1, {1, 0, 0}}}), Error);
  EXPECT_THROW(ScriptedDevice({{std::numeric_limits<double>::infinity(), {0, 0, 0}}}), Error);
  EXPECT_NO_THROW(ScriptedDevice({{3, {0, 0, 0}}}));
}

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

TEST(PacedDevice, WaitsForAReaderThatIsLaterThanItIsToCatchUp) {
  SimulatedDevice device({.position = {0, 0, 0.01}, .duration = 100.0});
  HandClock clock;
  PacedDevice paced(device, clock, 5);
  const Vector3d before = paced.read().position;
  paced.write({0, 0, 1});
  clock.time += 0.4;
  EXPECT_NEAR(paced.read().time, 5e-3, 1e-9);
  EXPECT_LT((paced.read().position - before).norm(), 0.5 * 1 / 0.1 * 5e-3 * 5e-3)
      << "no more than a newton moves it in five steps";
  clock.time += 1e-3;
  EXPECT_NEAR(paced.read().time, 6e-3, 1e-9);
}

TEST(PacedDevice, TellsWhenTheDeviceHasFinishedOrFailed) {
  ScriptedDevice device({{0, Vector3d::Zero()}, {1e-3, Vector3d::Zero()}});
  HandClock clock;
  PacedDevice paced(device, clock);
  EXPECT_EQ(paced.read().status, DeviceState::Status::ok);
  clock.time += 1;
  EXPECT_EQ(paced.read().status, DeviceState::Status::finished);

  SimulatedDevice broken;
  PacedDevice other(broken, clock);
  static_cast<void>(other.read());
  other.write(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  clock.time += 1;
  EXPECT_EQ(other.read().status, DeviceState::Status::failed);
  EXPECT_FALSE(other.reason().empty());
}

}  // namespace

}  // namespace palpate
