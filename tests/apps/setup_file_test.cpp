#include <fmt/format.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>

#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"
#include "depth/description.hpp"
#include "field/description.hpp"
#include "prepare/description.hpp"
#include "scene/description.hpp"
#include "servo/description.hpp"

namespace palpate::app {
namespace {

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
mesh_spacing = 0.002

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
  const TouchPlan plan = planned(shell, kDesk, "");
  EXPECT_EQ(plan.surface.field.kind, FieldOptions::Kind::pointset);
  EXPECT_EQ(plan.surface.field.tool_radius, 0.002);
  EXPECT_EQ(plan.surface.stiffness, 700);
  EXPECT_EQ(plan.motion.seed, 9u);
  EXPECT_FALSE(plan.time.real_time);
  EXPECT_EQ(plan.motion.trajectory, shell.path("hand.csv"));

  const std::vector<SourcePlan>& sources = plan.sources;
  ASSERT_EQ(sources.size(), 2u);
  EXPECT_EQ(sources[0].argument.name, "left");
  EXPECT_EQ(sources[0].argument.path, "camera:simulated:left");
  EXPECT_EQ(sources[0].kind, SourceKind::stream);
  EXPECT_EQ(sources[0].options.policy.policy, Policy::crossfade);
  ASSERT_TRUE(sources[0].options.depth.noise);
  EXPECT_EQ(sources[0].options.depth.noise->coefficients, (std::array<double, 3>{0.001, 0, 0.002}));
  EXPECT_EQ(sources[0].options.depth.noise->correlation, 1.5);
  const Eigen::Isometry3d& pose = sources[0].options.T_world_sensor;
  EXPECT_LT((pose * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(-0.5, 0, 0.25)).norm(), 1e-12);
  EXPECT_EQ(sources[1].argument.name, "mug");
  EXPECT_EQ(sources[1].argument.path, shell.path("scans/mug.ply"));
  EXPECT_EQ(sources[1].kind, SourceKind::cloud);
  EXPECT_EQ(sources[1].reading.scale, 0.001);
  EXPECT_EQ(sources[1].reading.mesh_spacing, 0.002);
  EXPECT_EQ(sources[1].options.policy.policy, Policy::morph)
      << "of [stream], for sources that say nothing else";
}

TEST(SetupFile, NamesOneDeviceOrOneForEachHand) {
  const Shell shell;
  const std::string from = "[[source]]\nfrom = \"synthetic:torus\"\n[hand]\n";
  const auto devices = [&](const std::string& hand, const std::string& arguments) {
    return planned(shell, from + hand, arguments).devices;
  };
  EXPECT_EQ(devices("device = \"scripted\"\n", "").at(0).kind, DeviceKind::scripted);
  const std::string both = "device = [\"simulated\", \"remote:/tmp/hand\"]\n";
  const std::vector<DevicePlan> two = devices(both, "");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].kind, DeviceKind::simulated);
  EXPECT_EQ(two[1].path, "/tmp/hand");
  const std::vector<DevicePlan> given = devices(both, "--device scripted");
  ASSERT_EQ(given.size(), 1u);
  EXPECT_EQ(given[0].kind, DeviceKind::scripted);
  const DevicePlan placed =
      planned(shell,
              "[[source]]\nname = \"left\"\nfrom = \"camera:simulated\"\n[hand]\n"
              "device = \"haply:04EA,frame=camera,scale=2,clutch=0\"\n",
              "")
          .devices.front();
  EXPECT_EQ(placed.path, "haply:04EA");
  EXPECT_EQ(placed.placement.frame, "left");
  EXPECT_EQ(placed.placement.scale, 2);
}

TEST(SetupFile, WhatIsNotSaidIsAsTheLibraryHasIt) {
  const Shell shell;
  const TouchPlan plan = planned(shell, "[[source]]\nfrom = \"camera:simulated\"\n", "");
  const SourceOptions& source = plan.sources.front().options;
  EXPECT_EQ(source.policy.silence, PolicyOptions{}.silence);
  EXPECT_FALSE(source.policy.fit_everywhere);
  EXPECT_FALSE(source.policy.clip_to_reach);
  EXPECT_EQ(source.depth.memory, DepthFilterOptions{}.memory);
  EXPECT_EQ(source.depth.farthest, DepthFilterOptions{}.farthest);
  EXPECT_EQ(source.depth.normal_error, DepthFilterOptions{}.normal_error);
  EXPECT_EQ(source.prepare.normal_error, PrepareOptions{}.normal_error);
  EXPECT_TRUE(plan.surface.field.sharp_edges);
  EXPECT_EQ(plan.time.guard.slew, GuardOptions{}.slew);
  EXPECT_EQ(plan.time.guard.maximum_force, GuardOptions{}.maximum_force);
  EXPECT_EQ(plan.time.guard.silence, GuardOptions{}.silence);
  EXPECT_EQ(plan.time.guard.damping, GuardOptions{}.damping);
  EXPECT_TRUE(plan.time.guard.passivity.on);
  EXPECT_TRUE(plan.time.realtime.realtime_priority);
  EXPECT_FALSE(plan.time.realtime.processor);
}

TEST(SetupFile, EveryPartAndKeyIsDocumented) {
  std::ifstream file(PALPATE_DOCS "/setup.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  CLI::App app;
  OptionTable table(app);
  TouchChoices choices;
  add_touch_options(table, choices);
  std::set<std::string> sections;
  int of_sources = 0;
  for (const Registration& each : table.all()) {
    if (each.section.empty()) continue;
    sections.insert(each.section);
    EXPECT_EQ(table.find(each.section, each.key()), &each);
    of_sources += table.find("source", each.key()) == &each;
    EXPECT_NE(text.find("`[" + each.section + "]`"), std::string::npos) << each.section;
    EXPECT_NE(text.find("`" + each.key() + "`"), std::string::npos) << each.key();
  }
  EXPECT_EQ(sections, (std::set<std::string>{"reading", "stream", "surface", "material", "hand",
                                             "tool", "guard", "servo", "ros"}));
  EXPECT_EQ(of_sources, 22);
}

template <class Options>
void expect_explained(const std::string& text) {
  const Options options;
  each_option(options, [&](const std::string& key, const About& about, const auto& /*member*/) {
    if (about.offered != Offered::files) return;
    EXPECT_NE(text.find(fmt::format("| `{}` |", key)), std::string::npos) << key;
    EXPECT_NE(text.find(fmt::format("| {}", about.help)), std::string::npos) << about.help;
  });
}

TEST(SetupFile, KeysOfTheFileAloneAreExplainedAsTheyAreDescribed) {
  std::ifstream file(PALPATE_DOCS "/setup.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  expect_explained<PrepareOptions>(text);
  expect_explained<PolicyOptions>(text);
  expect_explained<DepthFilterOptions>(text);
  expect_explained<FieldOptions>(text);
  expect_explained<GuardOptions>(text);
}

TEST(SetupFile, CommandLineWins) {
  const Shell shell;
  const TouchPlan plan = planned(
      shell, kDesk,
      "left=sequence:monday other.ply --policy average --field metaball --pose mug=1,0,0,0,0,0,1");
  EXPECT_EQ(plan.surface.field.kind, FieldOptions::Kind::metaball);
  const std::vector<SourcePlan>& sources = plan.sources;
  ASSERT_EQ(sources.size(), 3u);
  const auto x = [](const SourcePlan& source) {
    return source.options.T_world_sensor.translation().x();
  };
  EXPECT_EQ(sources[0].argument.path, "sequence:monday");
  EXPECT_EQ(sources[0].options.policy.policy, Policy::average) << "in every source";
  EXPECT_NEAR(x(sources[0]), 0.5, 1e-12) << "the pose stays";
  EXPECT_NEAR(x(sources[1]), 1, 1e-12);
  EXPECT_EQ(sources[2].argument.name, "other");
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

TEST(SetupFile, ServesRunsOfSeveralKindsButNotOtherSources) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("hand.csv", press_and_slide());
  const std::string common =
      "[[source]]\nfrom = \"plane.xyz\"\n[guard]\nmaximum_force = 1\n[hand]\nseed = 3\n";
  shell.write("desk.toml", common + "[stream]\nlatency = 0.02\n");
  const Outcome played = shell.run("touch --setup desk.toml --trajectory hand.csv");
  EXPECT_EQ(played.code, 0) << played.err;
  shell.write("desk.toml", common + "[stream]\nmemory = 3\n");
  const Outcome useless = shell.run("touch --setup desk.toml --trajectory hand.csv");
  EXPECT_EQ(useless.code, 1) << useless.err;
  EXPECT_NE(useless.err.find("desk.toml, line 8: 'memory'"), std::string::npos) << useless.err;
}

}  // namespace
}  // namespace palpate::app
