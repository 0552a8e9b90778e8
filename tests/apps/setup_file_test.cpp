#include "apps/palpate/options/setup_file.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>

#include "apps/palpate/options/chosen_source.hpp"
#include "apps/palpate/options/setup_keys.hpp"
#include "apps/palpate/options/touch_surface.hpp"
#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"
#include "support/effort.hpp"

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

// The nth set-up in docs/setup.md.
std::string documented(int n) {
  std::ifstream file(PALPATE_DOCS "/setup.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string_view fence = "```toml\n";
  std::size_t begin = text.find(fence);
  for (; n > 0; --n) begin = text.find(fence, begin + 1);
  begin += fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

TEST(SetupFile, TheDocumentedOneRunsAsItIs) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  shell.write("desk.toml", documented(0));
  const Outcome outcome =
      shell.run("touch --setup desk.toml --simulated-time --duration 1 --no-view");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("camera:simulated:desk"), std::string::npos) << outcome.out;
  const std::vector<ChosenSource> hardware = choose_sources(parsed(shell, documented(1), ""));
  ASSERT_EQ(hardware.size(), 2u);
  EXPECT_EQ(hardware[0].argument.path, "camera:openni2");
  EXPECT_EQ(hardware[1].argument.path, shell.path("scans/bench.ply"));
}

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

constexpr const char* kEverything = R"([[source]]
from = "camera:simulated"
memory = 3
[[source]]
name = "other"
from = "camera:simulated"
fit_everywhere = false
normal_error = 0.005

[reading]
viewpoint = [0, 0, 1.2]
unorganised = false

[stream]
silence = 0.7
fade = 0.9
nearest = 0.4
farthest = 2
memory = 12
fit_everywhere = true
clip_to_reach = true

[surface]
normal_error = 0.01
sharp_edges = false

[guard]
maximum_force = 2.5
slew = 150
watchdog = 0.02
damping = 0.7
soft_start = 0.1
passivity = false

[servo]
processor = 1
realtime = false
priority = 60
lock_memory = false
)";

TEST(SetupFile, NamesOneDeviceOrOneForEachHand) {
  const Shell shell;
  const std::string from = "[[source]]\nfrom = \"synthetic:torus\"\n[hand]\n";
  using Devices = std::vector<std::string>;
  EXPECT_EQ(parsed(shell, from + "device = \"scripted\"\n", "").devices, Devices{"scripted"});
  const std::string two = from + "device = [\"simulated\", \"remote:/tmp/hand\"]\n";
  EXPECT_EQ(parsed(shell, two, "").devices, (Devices{"simulated", "remote:/tmp/hand"}));
  EXPECT_EQ(parsed(shell, two, "--device scripted").devices, Devices{"scripted"});
  const std::string stand = "haply:04EA,frame=left,scale=2,clutch=0";
  EXPECT_EQ(parsed(shell, from + "device = \"" + stand + "\"\n", "").devices, Devices{stand});
}

TEST(SetupFile, EveryChoiceReachesTheLibrary) {
  const Shell shell;
  const TouchOptions options = parsed(shell, kEverything, "");
  const std::vector<ChosenSource> sources = choose_sources(options);
  ASSERT_EQ(sources.size(), 2u);
  const SourceOptions first = source_options(options, sources[0]);
  EXPECT_EQ(first.policy.silence, 0.7);
  EXPECT_EQ(first.policy.fade, 0.9);
  EXPECT_TRUE(first.policy.fit_everywhere);
  EXPECT_TRUE(first.policy.clip_to_reach);
  EXPECT_EQ(first.depth.nearest, 0.4);
  EXPECT_EQ(first.depth.farthest, 2);
  EXPECT_EQ(first.depth.memory, 3) << "its own";
  EXPECT_EQ(first.depth.normal_error, 0.01);
  EXPECT_EQ(first.prepare.normal_error, 0.01);
  ASSERT_TRUE(first.prepare.viewpoint);
  EXPECT_EQ(first.prepare.viewpoint->z(), 1.2);
  const SourceOptions second = source_options(options, sources[1]);
  EXPECT_EQ(second.depth.memory, 12) << "of [stream]";
  EXPECT_FALSE(second.policy.fit_everywhere);
  EXPECT_EQ(second.depth.normal_error, 0.005);
  EXPECT_FALSE(field_options(options).sharp_edges);
  const GuardOptions guard = guard_options(options.live);
  EXPECT_EQ(guard.maximum_force, 2.5);
  EXPECT_EQ(guard.slew, 150);
  EXPECT_EQ(guard.silence, 0.02);
  EXPECT_EQ(guard.damping, 0.7);
  EXPECT_EQ(guard.soft_start, 0.1);
  EXPECT_FALSE(guard.passivity.on);
  const RealtimeOptions realtime = realtime_options(options.live);
  EXPECT_EQ(realtime.processor, 1);
  EXPECT_FALSE(realtime.realtime_priority);
  EXPECT_EQ(realtime.priority, 60);
  EXPECT_FALSE(realtime.lock_memory);
}

TEST(SetupFile, WhatIsNotSaidIsAsTheLibraryHasIt) {
  const Shell shell;
  const TouchOptions options = parsed(shell, "[[source]]\nfrom = \"camera:simulated\"\n", "");
  const SourceOptions source = source_options(options, choose_sources(options).front());
  EXPECT_EQ(source.policy.silence, PolicyOptions{}.silence);
  EXPECT_FALSE(source.policy.fit_everywhere);
  EXPECT_FALSE(source.policy.clip_to_reach);
  EXPECT_EQ(source.depth.memory, DepthFilterOptions{}.memory);
  EXPECT_EQ(source.depth.farthest, DepthFilterOptions{}.farthest);
  EXPECT_EQ(source.depth.normal_error, DepthFilterOptions{}.normal_error);
  EXPECT_EQ(source.prepare.normal_error, PrepareOptions{}.normal_error);
  EXPECT_TRUE(field_options(options).sharp_edges);
  EXPECT_EQ(guard_options(options.live).slew, GuardOptions{}.slew);
  EXPECT_EQ(guard_options(options.live).maximum_force, GuardOptions{}.maximum_force);
  EXPECT_EQ(guard_options(options.live).silence, GuardOptions{}.silence);
  EXPECT_EQ(guard_options(options.live).damping, GuardOptions{}.damping);
  EXPECT_TRUE(guard_options(options.live).passivity.on);
  EXPECT_TRUE(realtime_options(options.live).realtime_priority);
  EXPECT_FALSE(realtime_options(options.live).processor);
}

TEST(SetupFile, EveryPartAndKeyIsTaken) {
  for (const char* section :
       {"source", "reading", "stream", "surface", "material", "hand", "guard", "servo"}) {
    ASSERT_FALSE(keys_of(section).empty()) << section;
    TouchOptions options;
    CLI::App taker;
    add_touch_options(taker, options);
    add_setup_options(taker, options);
    for (const SetupKey& key : keys_of(section)) {
      EXPECT_NE(taker.get_option_no_throw(option_of(key.key)), nullptr) << key.key;
    }
  }
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
