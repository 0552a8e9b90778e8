// `palpate align` run as a user does: its set-up file is one that the program reads.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"

namespace palpate::app {
namespace {

constexpr const char* kRough = R"([[source]]
from = "camera:simulated:left"
noise = "kinect1"

[[source]]
name = "right"
from = "camera:simulated:right"
pose = [0.06, -0.05, 0.03,  0.0, 0.05, 0.03, 0.9983]

[hand]
seed = 4
)";

// Three walls of 9 x 9 cm that meet at right angles.
std::string corner_xyz() {
  std::string corner;
  for (int i = 0; i < 900; ++i) {
    const double a = 0.003 * (i % 30), b = 0.003 * (i / 30);
    corner += fmt::format("0 {0} {1}\n{0} 0 {1}\n{0} {1} 0\n", a + 0.003, b + 0.003);
  }
  return corner;
}

// The frames tell their true poses: aligned, the recording's frame is the world again.
TEST(AlignProgram, WritesASetupWhosePosesAreRight) {
  Shell shell;
  shell.write("rough.toml", kRough);
  const Outcome outcome =
      shell.run("align --setup rough.toml --nearest 0.2 --output aligned.toml --json aligned.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word : {"before", "after", "sigma", "--pose right="}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
  const TouchPlan plan = planned(shell, shell.read("aligned.toml"), "");
  EXPECT_EQ(plan.motion.seed, 4U);
  ASSERT_EQ(plan.sources.size(), 2U);
  EXPECT_EQ(plan.sources[0].options.depth.noise->coefficients, parse_noise("kinect1").coefficients);
  EXPECT_EQ(plan.sources[1].argument.path, "camera:simulated:right");
  for (const SourcePlan& source : plan.sources) {
    EXPECT_EQ(source.options.depth.nearest, 0.2) << "as the command line has it";
    const Eigen::Isometry3d& pose = source.options.T_world_sensor;
    EXPECT_LT(pose.translation().norm(), 3e-3);
    EXPECT_LT(Eigen::AngleAxisd(pose.linear()).angle(), 0.5 * 0.01745);
  }
  const auto report = nlohmann::json::parse(shell.read("aligned.json"));
  EXPECT_LT(report[1]["after"]["residual_m"], 1e-3);
  EXPECT_LT(report[1]["sigma"]["place_m"], 3e-3);
  EXPECT_EQ(shell.run("touch --setup aligned.toml --simulated-time --duration 0.5").code, 0);
}

TEST(AlignProgram, NamesFilesFromTheSetupsFolder) {
  Shell shell;
  ASSERT_EQ(std::filesystem::create_directory(shell.path("setups")), true);
  std::filesystem::create_directory(shell.path("clouds"));
  shell.write("clouds/a.xyz", corner_xyz());
  shell.write("clouds/b.xyz", corner_xyz());
  const Outcome outcome = shell.run(
      "align clouds/a.xyz clouds/b.xyz --pose b=0.01,0.01,0,0,0,0,1 --output setups/desk.toml");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(shell.read("setups/desk.toml").find("../clouds/a.xyz"), std::string::npos);
  EXPECT_EQ(shell.run("touch --setup setups/desk.toml --duration 0.1").code, 0);
}

TEST(AlignProgram, TellsThePosesOfFilesWithoutASetup) {
  Shell shell;
  shell.write("corner.xyz", corner_xyz());
  const Outcome outcome = shell.run("align a=corner.xyz b=corner.xyz --pose b=0.01,0.01,0,0,0,0,1");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("palpate:"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("--pose b="), std::string::npos) << outcome.out;
}

TEST(AlignProgram, RefusesWhatHoldsNoAnswer) {
  Shell shell;
  const Outcome slides =
      shell.run("align camera:simulated:slant b=camera:simulated:slant,view=20 --output desk.toml");
  EXPECT_EQ(slides.code, 1);
  EXPECT_NE(slides.err.find("'b' with the others leaves it free to slide along"), std::string::npos)
      << slides.err;
  EXPECT_FALSE(std::filesystem::exists(shell.path("desk.toml")));
  EXPECT_EQ(shell.run("align camera:simulated").code, 2);
  shell.write("mine.toml", "# by hand");
  const Outcome there = shell.run("align synthetic:torus synthetic:box --output mine.toml");
  EXPECT_EQ(there.code, 2);
  EXPECT_NE(there.err.find("is not overwritten"), std::string::npos) << there.err;
  EXPECT_EQ(shell.read("mine.toml"), "# by hand");
}

}  // namespace
}  // namespace palpate::app
