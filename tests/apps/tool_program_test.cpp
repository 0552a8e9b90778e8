// The program with a tool that turns: what is felt, written, said and refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"
#include "support/effort.hpp"
#include "support/mesh_files.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;
using testing::Not;

double largest(const std::vector<std::string>& cells) {
  double most = 0;
  for (const std::string& cell : cells) most = std::max(most, std::abs(number(cell)));
  return most;
}
TEST(ToolProgram, ExploresWithABoxAndTellsPoseAndWrench) {
  Shell shell;
  const Outcome outcome = shell.run(
      "touch synthetic:torus --tool box:20x30x10 --duration 3 --log log.csv --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("box:20x30x10: "));
  EXPECT_THAT(outcome.out, HasSubstr("torque"));
  auto log = columns(shell.read("log.csv"));
  const std::size_t rows = log.at("t").size();
  for (const char* name :
       {"qw", "gripper", "tool_qx", "tool_qw", "tool_opening", "torque_x", "torque_z", "grip"}) {
    ASSERT_EQ(log[name].size(), rows) << name;
  }
  EXPECT_GT(largest(log["torque_x"]), 1e-3);
  EXPECT_GT(largest(log["tool_qx"]), 1e-3);
  EXPECT_EQ(largest(log["tool_opening"]), 0);
  const Json report = Json::parse(shell.read("report.json"));
  EXPECT_EQ(report["tool"]["shape"], "box:20x30x10");
  EXPECT_GT(report["tool"]["samples"].get<int>(), 50);
  EXPECT_LE(report["tool"]["samples"].get<int>(), 500);
  EXPECT_GT(report["largest_torque_Nm"].get<double>(), 1e-3);
  EXPECT_GT(report["contacts"].get<int>(), 0);
}

// The box's middle is pushed 3 mm deeper than its lower face can be, by a hand that does not turn.
TEST(ToolProgram, AFlatBoxIsHeldHalfItsHeightAboveAPlane) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  std::string way = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < 300; ++i) {
    way += fmt::format("{},0,0,{}\n", 1e-3 * i, std::max(7e-3, 13e-3 - 5e-5 * i));
  }
  shell.write("way.csv", way);
  const Outcome outcome =
      shell.run("touch plane.xyz --trajectory way.csv --tool box:20x20x20 --log log.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto log = columns(shell.read("log.csv"));
  EXPECT_NEAR(number(log["proxy_z"].back()), 0.01, 1e-4);
  EXPECT_NEAR(number(log["fz"].back()), 500 * 3e-3, 0.05);
  EXPECT_NEAR(number(log["tool_qw"].back()), 1, 1e-4);
}

// Dragged flat by a hand that is 3 mm deep, it is held back by 0.4 of its load.
TEST(ToolProgram, ABoxRubsOnAPlane) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  std::string way = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < 400; ++i) {
    way += fmt::format("{},{},0,{}\n", 1e-3 * i, 2e-5 * std::max(0, i - 200),
                       std::max(7e-3, 13e-3 - 5e-5 * i));
  }
  shell.write("way.csv", way);
  const Outcome outcome = shell.run(
      "touch plane.xyz --trajectory way.csv --tool box:20x20x20 --friction-dynamic 0.4 --log "
      "log.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto log = columns(shell.read("log.csv"));
  EXPECT_NEAR(number(log["fz"].back()), 500 * 3e-3, 0.05);
  EXPECT_NEAR(number(log["fx"].back()), -0.4 * number(log["fz"].back()), 0.02);
}

// A point that is dragged over the plane goes down between its grains, at most by two amplitudes.
TEST(ToolProgram, ABallFeelsTheTextureOfAPlane) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("set.toml", "[material]\ntexture_amplitude = 0.0001\ntexture_wavelength = 0.004\n");
  std::string way = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < 800; ++i) {
    way += fmt::format("{},{},0,{}\n", 1e-3 * i, 2e-5 * std::max(0, i - 200),
                       std::max(-2e-3, 4e-3 - 5e-5 * i));
  }
  shell.write("way.csv", way);
  const auto forces = [&shell](const std::string& rest) {
    const Outcome outcome =
        shell.run("touch plane.xyz --trajectory way.csv --tool ball:1 --log log.csv " + rest);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return columns(shell.read("log.csv"))["fz"];
  };
  const std::vector<std::string> smooth = forces("");
  const std::vector<std::string> carved = forces("--setup set.toml");
  EXPECT_EQ(carved, forces("--texture-amplitude 1e-4"));
  double least = 0;
  double most = -1;
  for (std::size_t i = 300; i < smooth.size(); ++i) {
    const double deeper = (number(carved.at(i)) - number(smooth[i])) / 500;
    least = std::min(least, deeper);
    most = std::max(most, deeper);
  }
  EXPECT_GT(least, -2.1e-4);
  EXPECT_LT(least, -1e-4);
  EXPECT_LT(most, 1e-5);
  EXPECT_GT(most - least, 5e-5);
}

TEST(ToolProgram, SameInputTwiceGivesTheSameLogBitForBit) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  const std::string arguments =
      "touch camera:simulated --simulated-time --tool capsule:60x4 --turn-stiffness 0.2 "
      "--duration 1.5 --log ";
  ASSERT_EQ(shell.run(arguments + "a.csv").code, 0);
  ASSERT_EQ(shell.run(arguments + "b.csv").code, 0);
  const std::string a = without_times(shell, "a.csv");
  EXPECT_GT(largest(columns(shell.read("a.csv"))["fz"]), 0.1);
  EXPECT_TRUE(a == without_times(shell, "b.csv"));
}

TEST(ToolProgram, RefusesWhatItDoesNotRenderAndWhatIsNoTool) {
  Shell shell;
  shell.write("large.ply", test::as_ply(test::box_mesh(Eigen::Vector3d(30, 20, 10))));
  shell.write("points.xyz", plane_xyz());
  const auto refusal = [&shell](const std::string& options) {
    const Outcome outcome = shell.run("touch synthetic:torus --duration 0.1 --tool " + options);
    EXPECT_NE(outcome.code, 0) << options;
    return outcome.err;
  };
  EXPECT_THAT(refusal("box:20x30x10 --tool-radius 0.001"),
              HasSubstr("--tool-radius is for a point"));
  EXPECT_THAT(refusal("ball:4 --preset paper"), HasSubstr("--preset paper uses a point tool"));
  EXPECT_THAT(refusal("gripper:10x10x30 --robot crisp --view --headless"),
              HasSubstr("not how far it is open"));
  EXPECT_THAT(refusal("bowl:4"), HasSubstr("give one of ball:R, capsule:LxR"));
  EXPECT_THAT(refusal("bowl:4"), HasSubstr("or mesh:FILE"));
  EXPECT_THAT(refusal("box:20x30"), HasSubstr("give box:XxYxZ in millimetres"));
  EXPECT_THAT(refusal("mesh:"), HasSubstr("mesh: names no file"));
  EXPECT_THAT(refusal("mesh:-"), HasSubstr("name its file"));
  EXPECT_THAT(refusal("mesh:large.ply,unit=0.001 --log large.ply"), HasSubstr("large.ply"));
  EXPECT_THAT(refusal("mesh:absent.stl"), HasSubstr("absent.stl"));
  EXPECT_THAT(refusal("mesh:points.xyz"), HasSubstr("there are no faces in it"));
  EXPECT_THAT(refusal("mesh:large.ply,unit=0"), HasSubstr("unit=0 is out of range"));
  EXPECT_THAT(refusal("ball:4 --turn-stiffness 0"), HasSubstr("above 0"));
  EXPECT_THAT(refusal("ball:4 --stiffness 1 --turn-stiffness 1000"),
              HasSubstr("--turn-stiffness 1000 is out of range where the stiffness is 1 N/m"));
  EXPECT_THAT(shell.run("touch synthetic:torus --turn-stiffness 1").err, HasSubstr("add --tool"));
}

TEST(ToolProgram, OnACameraTheRadiusIsNotKnown) {
  Shell shell;
  const Outcome outcome = shell.run("info camera:simulated --tool ball:3");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("ball:3: 1 balls"));
}

TEST(ToolProgram, KeysOfASetUpFileAreItsOptions) {
  const Shell shell;
  const std::string keys =
      "[tool]\ntool = \"gripper:6x12x40\"\ntool_spacing = 0.002\nturn_stiffness = 0.3\n";
  const TouchPlan plan = planned(shell, keys, "synthetic:torus");
  EXPECT_EQ(plan.tool.text, "gripper:6x12x40");
  EXPECT_EQ(plan.tool.spacing, 0.002);
  EXPECT_EQ(plan.tool.turn_stiffness, 0.3);
  EXPECT_EQ(planned(shell, keys, "synthetic:torus --tool ball:3").tool.text, "ball:3");
  EXPECT_EQ(planned(shell, "[tool]\ntool = \"mesh:part.stl\"\n", "synthetic:torus").tool.text,
            "mesh:" + shell.path("part.stl"));
}

TEST(ToolProgram, WhatIsOfAPointIsRefusedInASetUpFileToo) {
  Shell shell;
  for (const char* keys : {"[surface]\ntool_radius = 0.001\n", "[surface]\npreset = \"paper\"\n"}) {
    shell.write("set.toml", keys);
    const Outcome outcome = shell.run("touch synthetic:torus --setup set.toml --tool ball:3");
    EXPECT_EQ(outcome.code, 2) << keys;
    EXPECT_THAT(outcome.err, HasSubstr("--tool")) << keys;
  }
}

TEST(ToolProgram, InfoComparesSamplesWithACloudAndItsAdviceWorks) {
  Shell shell;
  const auto info = [&shell](const std::string& options) {
    const Outcome outcome = shell.run("info --json info.json " + options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(shell.read("info.json"))[0]["tool"];
  };
  const Json alone = info("--tool box:20x30x10");
  EXPECT_LE(alone["samples"].get<int>(), 500);
  EXPECT_EQ(alone["warning"], "");
  EXPECT_NEAR(alone["extent_m"].get<double>(), Eigen::Vector3d(10, 15, 5).norm() * 1e-3, 1e-12);
  EXPECT_GT(alone["turn_stiffness_Nm_per_rad"].get<double>(), 0.01);
  const Json fits = info("synthetic:torus --tool box:20x30x10");
  EXPECT_LE(fits["spacing_m"].get<double>(), 0.5 * fits["radius_m"].get<double>());
  EXPECT_EQ(fits["warning"], "");
  EXPECT_DOUBLE_EQ(fits["clearance_m"].get<double>(), 0.6 * fits["radius_m"].get<double>());
  const Json coarse = info("synthetic:torus --tool box:200x300x100");
  const auto warning = coarse["warning"].get<std::string>();
  ASSERT_THAT(warning, HasSubstr("more than half of R"));
  const std::string option = "--tool-spacing ";
  const std::size_t at = warning.find(option);
  ASSERT_NE(at, std::string::npos);
  const std::string advice = warning.substr(at, warning.find(',', at) - at);
  const Json followed = info("synthetic:torus --tool box:200x300x100 " + advice);
  EXPECT_THAT(followed["warning"].get<std::string>(), Not(HasSubstr("more than half of R")));
  EXPECT_GT(followed["samples"].get<int>(), 500);
}

TEST(ToolProgram, ATooSmallSpacingIsNamedAndItsAdviceWorks) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  shell.write("part.stl", test::as_stl(test::box_mesh(Eigen::Vector3d(10, 15, 5))));
  for (const char* tool : {"mesh:part.stl", "box:20x30x10", "gripper:6x12x30", "ball:30"}) {
    const auto with = [&](std::string_view spacing) {
      return shell.run(fmt::format("info --tool {} --tool-spacing {}", tool, spacing));
    };
    const Outcome refused = with("1e-5");
    EXPECT_EQ(refused.code, 2) << tool;
    ASSERT_THAT(refused.err, HasSubstr("--tool-spacing (tool_spacing of [tool]): 1e-05 m leaves"));
    const std::size_t give = refused.err.find("give ") + 5;
    const std::string advice = refused.err.substr(give, refused.err.find(' ', give) - give);
    EXPECT_EQ(with(advice).code, 0) << tool << ' ' << advice;
  }
  shell.write("set.toml", "[tool]\ntool = \"box:20x30x10\"\ntool_spacing = 0.00001\n");
  const Outcome refused = shell.run("touch synthetic:torus --setup set.toml --duration 0.1");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("tool_spacing of [tool]"));
}

}  // namespace
}  // namespace palpate::app
