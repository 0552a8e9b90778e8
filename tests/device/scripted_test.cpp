#include "palpate/device/scripted.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "palpate/base/error.hpp"

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
    EXPECT_EQ(state.status, DeviceStatus::ok);
    EXPECT_EQ(state.time, row.time);
    EXPECT_EQ(state.position, row.position);
    device.write({0, 0, 1});
  }
  const DeviceState last = device.read();
  EXPECT_EQ(last.status, DeviceStatus::finished);
  EXPECT_EQ(last.position, rows.back().position);
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
  EXPECT_EQ(device.read().status, DeviceStatus::failed);
  device.write({1, 0, 0});
  EXPECT_EQ(device.read().status, DeviceStatus::failed);
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

}  // namespace
}  // namespace palpate
