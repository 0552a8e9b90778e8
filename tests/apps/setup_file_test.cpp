#include "apps/palpate/setup_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "apps/palpate/chosen_source.hpp"
#include "apps/palpate/errors.hpp"
#include "apps/program.hpp"
#include "palpate/base/error.hpp"

namespace palpate::app {
namespace {

// As the program does with a command line after "palpate touch".
TouchOptions parsed(const Shell& shell, const std::string& toml, const std::string& arguments) {
  shell.write("desk.toml", toml);
  TouchOptions options;
  CLI::App command;
  add_touch_options(command, options);
  command.parse(fmt::format("--setup {} {}", shell.path("desk.toml"), arguments), false);
  apply_setup(command, options);
  return options;
}

std::string complaint(const Shell& shell, const std::string& toml) {
  try {
    (void)parsed(shell, toml, "");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

constexpr const char* kDesk = R"(# two things on a desk
[[source]]
name = "left"
from = "camera:simulated:left"
pose = [0.5, 0, 0.25, 0, 0, 1, 0]
policy = "crossfade"
noise = [0.001, 0, 0.002, 1.5]

[[source]]
from = "scans/mug.ply"
scale = 0.001

[stream]
policy = "morph"
simulated_time = true

[surface]
field = "pointset"
tool_radius = 0.002

[material]
stiffness = 700

[hand]
trajectory = "hand.csv"
seed = 9
)";

TEST(SetupFile, FillsInWhatTheCommandLineDoesNotSay) {
  const Shell shell;
  const TouchOptions options = parsed(shell, kDesk, "");
  EXPECT_EQ(options.field, "pointset");
  EXPECT_EQ(options.tool_radius, 0.002);
  EXPECT_EQ(options.stiffness, 700);
  EXPECT_EQ(options.seed, 9u);
  EXPECT_TRUE(options.simulated_time);
  EXPECT_EQ(options.trajectory, shell.path("hand.csv"));

  const std::vector<ChosenSource> sources = choose_sources(options);
  ASSERT_EQ(sources.size(), 2u);
  EXPECT_EQ(sources[0].argument.name, "left");
  EXPECT_EQ(sources[0].argument.path, "camera:simulated:left");
  EXPECT_EQ(sources[0].choices.policy, "crossfade");
  EXPECT_EQ(sources[0].choices.noise, "0.001,0,0.002,1.5");
  EXPECT_LT((sources[0].pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(-0.5, 0, 0.25)).norm(),
            1e-12);
  EXPECT_EQ(sources[1].argument.name, "mug");
  EXPECT_EQ(sources[1].argument.path, shell.path("scans/mug.ply"));
  EXPECT_EQ(sources[1].choices.reading.scale, 0.001);
  EXPECT_EQ(sources[1].choices.policy, "morph") << "of [stream], for sources that say nothing else";
}

TEST(SetupFile, CommandLineWins) {
  const Shell shell;
  const TouchOptions options = parsed(
      shell, kDesk,
      "left=sequence:monday other.ply --policy average --field metaball --pose mug=1,0,0,0,0,0,1");
  EXPECT_EQ(options.field, "metaball");
  const std::vector<ChosenSource> sources = choose_sources(options);
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_EQ(sources[0].argument.path, "sequence:monday");
  EXPECT_EQ(sources[0].choices.policy, "average") << "in every source";
  EXPECT_NEAR(sources[0].pose.translation().x(), 0.5, 1e-12) << "the pose stays";
  EXPECT_NEAR(sources[1].pose.translation().x(), 1, 1e-12);
  EXPECT_EQ(sources[2].argument.name, "other");
}

TEST(SetupFile, ErrorsNameFileLineAndKey) {
  const Shell shell;
  struct Case {
    const char* toml;
    std::vector<const char*> words;
  };
  const Case cases[] = {
      {"[surface]\nfield = \"pointset\"\nraduis = 0.01\n", {"line 3", "'raduis'", "radius"}},
      {"[surfaces]\nradius = 1\n", {"line 1", "'surfaces'", "surface"}},
      {"[surface]\nradius = \"wide\"\n", {"line 2", "'radius'", "text", "a number"}},
      {"[surface]\n\nradius = -0.5\n", {"line 3", "'radius'", "above 0"}},
      {"[surface]\nradius = nan\n", {"line 2", "'radius'", "above 0"}},
      {"[surface]\nfield = 3\n", {"line 2", "'field'", "a whole number", "text"}},
      {"[surface]\nfield = \"mesh\"\n", {"line 2", "'field'", "mesh"}},
      {"[stream]\nhistory = 2.5\n", {"line 2", "'history'", "a whole number"}},
      {"[stream]\nhistory = 9\n", {"line 2", "'history'", "1 to 7"}},
      {"[stream]\nloop = 1\n", {"line 2", "'loop'", "true or false"}},
      {"[hand]\nseed = -1\n", {"line 2", "'seed'", "-1"}},
      {"[[source]]\nfrom = \"a.ply\"\n[[source]]\nname = \"b\"\n", {"line 3", "'from'"}},
      {"[[source]]\nfrom = \"a.ply\"\npose = [1, 2]\n", {"line 3", "2 numbers instead of 7"}},
      {"[[source]]\nfrom = \"a.ply\"\npose = [0, 0, 0, 0, 0, 0, 2]\n", {"line 3", "quaternion"}},
      {"[[source]]\nfrom = \"a.ply\"\nintrinsics = [1, \"x\"]\n",
       {"line 3", "'intrinsics'", "text"}},
      {"[[source]]\nfrom = \"a.ply\"\nfield = \"metaball\"\n", {"line 3", "'field'", "[[source]]"}},
      {"[[source]]\nfrom = \"a.ply\"\nname = \"a b\"\n", {"line 3", "'name'", "a b"}},
      {"[[source]]\nname = \"a\"\nfrom = \"a\"\n[[source]]\nname = \"a\"\nfrom = \"b\"\n",
       {"line 4", "two sources", "'a'"}},
      {"source = \"a.ply\"\n", {"line 1", "[[source]]"}},
      {"surface = 3\n", {"line 1", "'surface'", "[surface]"}},
      {"[surface\n", {"line 1", "TOML"}},
  };
  for (const Case& each : cases) {
    const std::string text = complaint(shell, each.toml);
    EXPECT_NE(text.find("desk.toml"), std::string::npos) << each.toml << "\n" << text;
    for (const char* word : each.words) {
      EXPECT_NE(text.find(word), std::string::npos) << each.toml << "\n" << text << "\n" << word;
    }
  }
}

TEST(SetupFile, OneThatIsNotThereIsAnError) {
  const Shell shell;
  TouchOptions options;
  CLI::App command;
  add_touch_options(command, options);
  command.parse("--setup nowhere.toml", false);
  EXPECT_THROW(apply_setup(command, options), Error);
}

TEST(SetupFile, ProgramTouchesWhatItDescribes) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("hand.csv", press_and_slide());
  shell.write(
      "desk.toml",
      "[[source]]\nname = \"plate\"\nfrom = \"plane.xyz\"\n[hand]\ntrajectory = \"hand.csv\"\n"
      "[material]\nstiffness = 300\n");
  const Outcome outcome = shell.run("touch --setup desk.toml --log log.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto log = columns(shell.read("log.csv"));
  EXPECT_NEAR(std::stod(log["fz"][200]), 300 * 3e-3, 0.02);
  const Outcome wrong = shell.run("touch --setup desk.toml --stiffness 600 --log log.csv");
  ASSERT_EQ(wrong.code, 0) << wrong.err;
  log = columns(shell.read("log.csv"));
  EXPECT_NEAR(std::stod(log["fz"][200]), 600 * 3e-3, 0.04);
}

}  // namespace
}  // namespace palpate::app
