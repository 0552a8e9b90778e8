#include <gtest/gtest.h>

#include "palpate/device/simulated.hpp"
#include "viewer/reports.hpp"

namespace palpate::viewer {
namespace {

TEST(ToolNames, AreTheDevicesAndNumberedWhereSeveralHaveOne) {
  Scene scene;
  SimulatedDevice one;
  ScriptedDevice other(Trajectory{{0, Eigen::Vector3d::Zero()}, {1, Eigen::Vector3d::Zero()}});
  SimulatedDevice two;
  Servo first(one, scene);
  Servo second(other, scene);
  Servo third(two, scene);
  using Names = std::vector<std::string>;
  EXPECT_EQ(tool_names({&first, &second}), (Names{"simulated", "scripted"}));
  EXPECT_EQ(tool_names({&first, &second, &third}),
            (Names{"simulated 1", "scripted", "simulated 2"}));
  EXPECT_EQ(tool_names({}), Names{});
}

}  // namespace
}  // namespace palpate::viewer
