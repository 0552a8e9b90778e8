#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "apps/recorded_wall.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

// Down onto the middle of the simulated table, which is z = 0 there, and `seconds` of pressing.
std::string press_table(double seconds) {
  std::string text = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) {
    text += fmt::format("{},0,0,{}\n", 1e-3 * i, std::max(-4e-3, 0.02 - 1e-4 * i));
  }
  return text;
}

TEST(Streams, TwoCamerasGiveTheSameLogBitForBit) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  const std::string command =
      "touch camera:simulated:left camera:simulated:right,phase=0.011,jitter=0.004,seed=3 "
      "--simulated-time --duration 0.5 --log ";
  ASSERT_EQ(shell.run(command + "a.csv --json a.json").code, 0);
  ASSERT_EQ(shell.run(command + "b.csv").code, 0);
  EXPECT_EQ(without_times(shell, "a.csv"), without_times(shell, "b.csv"));
  const Json report = Json::parse(shell.read("a.json"));
  EXPECT_GT(report["largest_force_N"].get<double>(), 0.5);
  ASSERT_EQ(report["sources"].size(), 2u);
  for (const Json& source : report["sources"]) {
    EXPECT_GE(source["frames_touchable"].get<int>(), 14);
    EXPECT_NEAR(source["rate_Hz"].get<double>(), 30, 1.5);
    EXPECT_NEAR(source["latency_s"]["p50"].get<double>(), 0.01, 1e-9);
    EXPECT_EQ(source["policy"]["name"], "morph");
    EXPECT_GT(source["noise_m"].get<double>(), 1e-4);
    EXPECT_LT(source["disagreement_m"].get<double>(), 1e-3) << "both stand where they say";
  }
}

TEST(Streams, TrajectoryIsPlayedInTheWorldFromTheFirstFrameOn) {
  Shell shell;
  shell.write("way.csv", press_table(0.6));
  const Outcome outcome = shell.run(
      "touch camera:simulated:still --simulated-time --latency 0.05 --trajectory way.csv "
      "--log log.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto log = columns(shell.read("log.csv"));
  ASSERT_EQ(log["t"].size(), 600u);
  EXPECT_EQ(log["field_notes"][49], "2") << "no surface before stamp + latency";
  EXPECT_EQ(log["field_notes"][51], "0");
  EXPECT_NEAR(number(log["fz"].back()), 500 * 4e-3, 0.15);
  EXPECT_NEAR(number(log["proxy_z"].back()), 0, 3e-4);
}

TEST(Streams, EveryPolicyFeelsTheWall) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  write_wall(shell, 6);
  shell.write("way.csv", into_wall(270));
  for (const char* more : {"--policy replace", "--policy average --history 3", "--policy crossfade",
                           "--unorganised", "--preset paper --field pointset", "--noise kinect1"}) {
    const Outcome outcome =
        shell.run(fmt::format("touch sequence:wall --loop --simulated-time --trajectory way.csv "
                              "--log log.csv {}",
                              more));
    ASSERT_EQ(outcome.code, 0) << more << "\n" << outcome.err;
    auto log = columns(shell.read("log.csv"));
    EXPECT_NEAR(number(log["fz"].back()), -500 * 4e-3, 0.1) << more;
  }
}

TEST(Streams, SequenceEndsAndItsLastSurfaceStaysOrLoops) {
  Shell shell;
  write_wall(shell, 6);
  shell.write("way.csv", into_wall(2500));
  const std::string command =
      "touch sequence:wall --simulated-time --trajectory way.csv --log log.csv --json r.json ";
  const Outcome stays = shell.run(command);
  ASSERT_EQ(stays.code, 0) << stays.err;
  auto log = columns(shell.read("log.csv"));
  EXPECT_NEAR(number(log["fz"].back()), -500 * 4e-3, 0.05) << "2.3 s after the last frame";
  Json report = Json::parse(shell.read("r.json"));
  EXPECT_EQ(report["sources"][0]["phase"], "ended");
  EXPECT_EQ(report["sources"][0]["frames_touchable"], 6);
  const Outcome loops = shell.run(command + "--loop");
  ASSERT_EQ(loops.code, 0) << loops.err;
  report = Json::parse(shell.read("r.json"));
  EXPECT_EQ(report["sources"][0]["phase"], "running");
  EXPECT_EQ(report["sources"][0]["frames_touchable"], 75);
}

TEST(Streams, DepthsOutOfRangeAreNotBelieved) {
  Shell shell;
  write_wall(shell, 6);
  shell.write("way.csv", into_wall(300));
  const std::string command =
      "touch sequence:wall --simulated-time --trajectory way.csv --log log.csv ";
  for (const auto& [range, force] :
       std::initializer_list<std::pair<const char*, double>>{{"", -2},
                                                             {"--nearest 0.4 --farthest 0.6", -2},
                                                             {"--farthest 0.4", 0},
                                                             {"--nearest 0.6", 0}}) {
    const Outcome outcome = shell.run(command + range);
    ASSERT_EQ(outcome.code, 0) << range << "\n" << outcome.err;
    EXPECT_NEAR(number(columns(shell.read("log.csv"))["fz"].back()), force, 0.1) << range;
  }
}

TEST(Streams, DepthsThatAreAllOutOfRangeAreToldWithARemedy) {
  Shell shell;
  write_wall(shell, 6);
  std::string description = shell.read("wall/sequence.json");
  description.replace(description.find("0.001"), 5, "1.0");  // millimetres for metres
  shell.write("wall/sequence.json", description);
  shell.write("way.csv", into_wall(300));
  const std::string command = "touch sequence:wall --simulated-time --json r.json ";
  const Outcome explored = shell.run(command + "--duration 1");
  EXPECT_EQ(explored.code, 1);
  const Outcome led = shell.run(command + "--trajectory way.csv");
  ASSERT_EQ(led.code, 0) << led.err;
  for (const std::string& told : {explored.err, led.out}) {
    EXPECT_NE(told.find("farther than 20 m (median 500 m)"), std::string::npos) << told;
    EXPECT_NE(told.find("depth_unit_m"), std::string::npos) << told;
    EXPECT_EQ(told.find("--scale"), std::string::npos) << "is of files: " << told;
  }
  EXPECT_EQ(Json::parse(shell.read("r.json"))["sources"][0]["frames_touchable"], 0);
}

TEST(Streams, ClippingToReachLeavesTheForceAndMostPointsOut) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  write_wall(shell, 12);
  shell.write("way.csv", into_wall(320));
  const std::string command =
      "touch sequence:wall --unorganised --simulated-time --trajectory way.csv --log log.csv "
      "--json r.json ";
  double points[2] = {};
  for (const int clipped : {0, 1}) {
    const Outcome outcome = shell.run(command + (clipped == 1 ? "--clip-to-reach" : ""));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(number(columns(shell.read("log.csv"))["fz"].back()), -2, 0.1) << clipped;
    points[clipped] = Json::parse(shell.read("r.json"))["sources"][0]["points_felt"];
  }
  EXPECT_GT(points[1], 0);
  EXPECT_LT(points[1], 0.9 * points[0]);
}

TEST(Streams, BrokenImageIsReportedAndTheRestIsFelt) {
  Shell shell;
  write_wall(shell, 6);
  shell.write("wall/003.pgm", "P5 64 48 65535\ncut");
  const Outcome outcome =
      shell.run("touch wall=sequence:wall --simulated-time --duration 0.5 --json r.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("003.pgm"), std::string::npos) << outcome.out;
  const Json source = Json::parse(shell.read("r.json"))["sources"][0];
  EXPECT_EQ(source["frames_touchable"], 5);
  EXPECT_EQ(source["drops"]["garbage"], 1);
}

TEST(Streams, DepthUnitIsCorrectedWhereTheMessageSays) {
  Shell shell;
  write_wall(shell, 6);
  const auto run = [&] {
    const Outcome outcome =
        shell.run("touch wall=sequence:wall --simulated-time --duration 0.5 --json r.json");
    return outcome.out + outcome.err;
  };
  const std::string lens =
      R"({"width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5, "fps": 30, )";
  shell.write("wall/sequence.json", lens + R"("depth_unit_m": 0.5})");
  const std::string said = run();
  EXPECT_NE(said.find("correct the metres a step, depth_unit_m in its sequence.json"),
            std::string::npos)
      << said;
  shell.write("wall/sequence.json", lens + R"("depth_unit_m": 0.001})");
  EXPECT_EQ(run().find("depth_unit_m"), std::string::npos);
  EXPECT_EQ(Json::parse(shell.read("r.json"))["sources"][0]["frames_touchable"], 6);
}

TEST(Streams, AFrameWithoutAPoseIsCountedAsSuch) {
  Shell shell;
  write_wall(shell, 6);
  shell.write("wall/sequence.json",
              R"({"width": 64, "height": 48, "fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5,
                  "depth_unit_m": 0.001, "fps": 30, "pose": "poses.txt"})");
  std::string poses;
  for (const int i : {0, 1, 2, 4, 5}) {
    poses += fmt::format("{} {} 6\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", i, i);
  }
  shell.write("wall/poses.txt", poses);
  const Outcome outcome =
      shell.run("touch wall=sequence:wall --simulated-time --duration 0.5 --json r.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 without a pose"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("003.pgm"), std::string::npos) << outcome.out;
  const Json source = Json::parse(shell.read("r.json"))["sources"][0];
  EXPECT_EQ(source["frames_touchable"], 5);
  EXPECT_EQ(source["drops"]["unposed"], 1);
  EXPECT_EQ(source["drops"]["garbage"], 0);
  const Outcome info = shell.run("info sequence:wall");
  EXPECT_NE(info.out.find("1 frames without one skipped"), std::string::npos) << info.out;
}

TEST(Streams, FramesOfNoUseAreDroppedInSimulatedTimeAndTheReportSaysWhy) {
  Shell shell;
  write_wall(shell, 40);
  for (int i = 20; i < 40; ++i) shell.write(fmt::format("wall/{:03}.pgm", i), wall_pgm(19));
  shell.write("wall/005.pgm", "P5 64 48 65535\n" + std::string(std::size_t{2} * 64 * 48, '\0'));
  shell.write("way.csv", into_wall(1250));
  const Outcome outcome =
      shell.run("touch wall=sequence:wall --simulated-time --trajectory way.csv --json r.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("wall (sequence:wall): a frame identical to the previous one"),
            std::string::npos)
      << outcome.out;
  const Json source = Json::parse(shell.read("r.json"))["sources"][0];
  EXPECT_EQ(source["frames"], 38) << "38 had come at 1.25 s";
  EXPECT_EQ(source["drops"]["empty"], 1);
  EXPECT_EQ(source["drops"]["repeated"], 18);
  EXPECT_EQ(source["phase"], "stalled") << "the picture froze";
}

TEST(Streams, RecordingsThatBeginBlackAreExplored) {
  Shell shell;
  write_wall(shell, 40);
  const auto blacken = [&](int from, int to) {
    const std::string black = "P5 64 48 65535\n" + std::string(std::size_t{2} * 64 * 48, '\0');
    for (int i = from; i < to; ++i) shell.write(fmt::format("wall/{:03}.pgm", i), black);
  };
  blacken(0, 5);
  const std::string command = "touch sequence:wall --simulated-time --duration 1.2 --json r.json ";
  for (const char* more : {"", "--unorganised"}) {
    if (*more != '\0' && test::is_slow_build()) continue;  // Organised.* prepares such clouds, too
    const Outcome outcome = shell.run(command + more);
    ASSERT_EQ(outcome.code, 0) << more << "\n" << outcome.err;
    const Json report = Json::parse(shell.read("r.json"));
    EXPECT_GT(report["contacts"].get<int>(), 0) << more;
    EXPECT_EQ(report["sources"][0]["drops"]["empty"], 5) << "planning takes nothing from it";
  }
  blacken(5, 40);
  const Outcome outcome = shell.run(command);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("contains no surface"), std::string::npos) << outcome.err;
}

TEST(Streams, InfoCountsAFirstFrameThatIsDamaged) {
  Shell shell;
  write_wall(shell, 5);
  shell.write("wall/000.pgm", "P5 64 48 65535\n");
  const Outcome outcome = shell.run("info sequence:wall");
  EXPECT_NE(outcome.out.find("of the first 5: 0 repeated, 1 failed"), std::string::npos)
      << outcome.out << outcome.err;
}

TEST(Streams, WhatIsNotThereIsNamed) {
  Shell shell;
  for (const auto& [arguments, word] : std::initializer_list<std::pair<const char*, const char*>>{
           {"camera:simulated:nowhere --simulated-time", "nowhere"},
           {"camera:simulated:table,rate=nan --simulated-time", "rate: 'nan'"},
           {"camera:simulated:table,frames=1.5 --simulated-time", "frames: '1.5'"},
           {"camera:simulated:table,rate --simulated-time", "KEY=VALUE, not 'rate'"},
           {"camera:telescope --simulated-time", "telescope"},
           {"sequence:nowhere --simulated-time", "nowhere"},
           {"missing.oni --simulated-time", "missing.oni"},
           {"camera:simulated --simulated-time --soft-stiffness 100", "only depths"}}) {
    const Outcome outcome = shell.run(fmt::format("touch {}", arguments));
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << "\n" << outcome.err;
  }
}

}  // namespace
}  // namespace palpate::app
