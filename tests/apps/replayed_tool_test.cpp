// Recordings of a tool that turns: what they hold, and that a replay gives the same forces, torques
// and poses, bit for bit.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "apps/recorded_again.hpp"
#include "message/palpate_types.hpp"
#include "support/effort.hpp"
#include "support/mesh_files.hpp"
#include "support/rewritten_bag.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

// Records `touch ARGUMENTS` and does it again, with the same torques; its report.
Json record_tool_and_replay(Shell& shell, const std::string& arguments) {
  const Json replay = record_and_replay(shell, arguments);
  for (const Json& hand : replay["hands"]) EXPECT_EQ(hand["largest_torque_difference_Nm"], 0.0);
  return Json::parse(shell.read("run.json"));
}

TEST(ReplayedTool, OfACloudGivesTheSameLogBitForBit) {
  Shell shell;
  const Json report = record_tool_and_replay(
      shell,
      "synthetic:torus --tool box:20x30x10 --turn-stiffness 0.1 --texture-amplitude 1e-4 "
      "--duration 2 --log a.csv");
  EXPECT_GT(report["largest_torque_Nm"], 1e-3);
  ASSERT_EQ(shell.run("replay run.mcap --log b.csv").code, 0);
  EXPECT_TRUE(without_times(shell, "a.csv") == without_times(shell, "b.csv"));
  EXPECT_THAT(shell.read("b.csv"), HasSubstr(",torque_z,grip\n"));
}

TEST(ReplayedTool, OfAMeshNeedsNoFileOfIt) {
  Shell shell;
  shell.write("part.stl", test::as_stl(test::box_mesh(Eigen::Vector3d(10, 15, 5))));
  (void)record_tool_and_replay(shell, "synthetic:torus --tool mesh:part.stl --duration 1");
  Shell elsewhere;
  elsewhere.write("run.mcap", shell.read("run.mcap"));
  EXPECT_EQ(elsewhere.run("replay run.mcap").code, 0);
}

TEST(ReplayedTool, OfACameraInSimulatedTime) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  const Json report = record_tool_and_replay(
      shell, "camera:simulated --simulated-time --tool gripper:10x20x60 --duration 1.5");
  EXPECT_GT(report["recordings"][0]["frames"], 20);
  EXPECT_GT(report["largest_force_N"], 0.1);
}

TEST(ReplayedTool, OfTwoHandsInRealTime) {
  if (test::is_slow_build()) GTEST_SKIP() << "no surface is ready in time";
  Shell shell;
  const Json report = record_tool_and_replay(
      shell,
      "synthetic:torus --tool capsule:60x4 --device simulated --device simulated --duration 1.5");
  EXPECT_EQ(report["hands"].size(), 2u);
}

TEST(ReplayedTool, TellsWhereATorqueDiffers) {
  Shell shell;
  (void)record_tool_and_replay(shell, "synthetic:torus --tool box:20x30x10 --duration 1");
  const auto twist = [](message::ToolStep& step) { step.torque.x += 0.25; };
  shell.write("other.mcap",
              test::rewritten<message::ToolStep>(shell.read("run.mcap"), "/hand/tool", 41, twist));
  const Outcome outcome = shell.run("replay other.mcap --json other.json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("0.25 N m of torques"));
  const Json hand = Json::parse(shell.read("other.json"))["hands"][0];
  EXPECT_EQ(hand["first_step"], 42);
  EXPECT_EQ(hand["differing_steps"], 1);
  EXPECT_EQ(hand["largest_difference_N"], 0.0);
}

TEST(ReplayedTool, IsNoRecordingOfAnOlderProgramAndAPointsIs) {
  Shell shell;
  const auto kind_of = [&shell](const std::string& tool) {
    EXPECT_EQ(shell.run("touch synthetic:torus --duration 0.2 --record run.mcap" + tool).code, 0);
    std::string kind;
    (void)test::rewritten(shell.read("run.mcap"), [&](const std::string& name, bag::Bytes& data) {
      if (name == "setup.json") kind = Json::parse(data.begin(), data.end())["kind"];
      EXPECT_TRUE(!tool.empty() || !name.ends_with("/tool")) << name;
    });
    return kind;
  };
  EXPECT_EQ(kind_of(""), "palpate recording 3");
  EXPECT_EQ(kind_of(" --tool ball:3"), "palpate recording 4");
}

}  // namespace
}  // namespace palpate::app
