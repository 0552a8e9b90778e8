#include "apps/palpate/report/log.hpp"

#include <gtest/gtest.h>

#include "apps/program.hpp"

namespace palpate::app {
namespace {

std::string logged(const std::vector<ServoState>& steps, const DeviceInfo& device = {},
                   bool turns = false, double scale = 1) {
  const Shell shell;
  TouchLog log(shell.path("log.csv"), turns);
  for (const ServoState& step : steps) log.add(step, device, scale);
  log.close();
  return shell.read("log.csv");
}

TEST(TouchLog, HasAHeaderAndARowAStep) {
  const std::string none = logged({});
  EXPECT_TRUE(none.starts_with("t,hip_x,hip_y,hip_z,proxy_x"));
  EXPECT_TRUE(none.ends_with("field_notes\n"));
  const auto two = columns(logged({ServoState{}, ServoState{}}));
  EXPECT_EQ(two.at("field_notes").size(), 2u);
  EXPECT_FALSE(two.contains("qw"));
  EXPECT_FALSE(two.contains("gripper"));
}

TEST(TouchLog, TellsOrientationAndGripperAtTheEndWhereTheyAreKnown) {
  ServoState step;
  step.orientation = Eigen::Quaterniond(0.6, 0, -0.8, 0);
  step.gripper = 0.0125;
  DeviceInfo device;
  device.has_orientation = true;
  const auto oriented = columns(logged({step, step}, device));
  EXPECT_EQ(oriented.at("qw").back(), "0.6");
  EXPECT_EQ(oriented.at("qy").back(), "-0.8");
  EXPECT_FALSE(oriented.contains("gripper"));
  device.has_gripper = true;
  const std::string text = logged({step}, device);
  EXPECT_TRUE(text.ends_with(",0,-0.8,0,0.6,0.0125\n")) << text;
  EXPECT_EQ(columns(text).at("gripper").front(), "0.0125");
  EXPECT_EQ(columns(logged({step}, device, false, 2)).at("gripper").front(), "0.025");
}

TEST(TouchLog, OfAToolThatTurnsHasItsPoseAndTheWrenchAtTheEnd) {
  ServoState step;
  step.gripper = 0.03;
  step.tool.orientation = Eigen::Quaterniond(0.6, 0, 0, 0.8);
  step.tool.opening = 0.02;
  step.wrench.torque = {0.25, -0.5, 0.125};
  step.wrench.grip = 5;
  const std::string text = logged({step}, {}, true);
  EXPECT_TRUE(text.ends_with(",0,0,0,1,0.03,0,0,0.8,0.6,0.02,0.25,-0.5,0.125,5\n")) << text;
  EXPECT_EQ(columns(text).at("torque_y").front(), "-0.5");
  EXPECT_EQ(columns(text).at("grip").front(), "5");
  EXPECT_TRUE(logged({}, {}, true).ends_with(",torque_z,grip\n"));
}

}  // namespace
}  // namespace palpate::app
