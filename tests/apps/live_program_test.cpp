// Runs in real time. Nothing here depends on how fast the machine is.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

// The thread sanitizer wants one processor for all threads.
bool too_slow_for_cameras() {
  return test::effort(20) < 2;
}

TEST(LiveProgram, TouchesACameraInRealTimeAndTellsHowItWent) {
  if (too_slow_for_cameras()) GTEST_SKIP() << "no surface is ready in time";
  Shell shell;
  const Outcome outcome =
      shell.run("touch camera:simulated --duration 1.5 --json run.json --log forces.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("real time"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find(" Hz"), std::string::npos) << "a line a second: " << outcome.err;
  const Json run = Json::parse(shell.read("run.json"));
  EXPECT_GT(run["steps"], 10);
  EXPECT_GE(run["real_s"], 1.4);
  EXPECT_GT(run["sources"][0]["frames"], 0);
  const int least = test::is_slow_build() ? 0 : 1;  // made touchable while the run lasts
  EXPECT_GE(run["sources"][0]["frames_touchable"], least);
  const Json& live = run["live"];
  EXPECT_EQ(live["rate_Hz"], 1000);
  EXPECT_EQ(live["steps_unwritten"], 0);
  EXPECT_EQ(live["guard"]["faults"], 0);
  EXPECT_EQ(live["realtime"].size(), 2u);
  EXPECT_EQ(run["interrupted"], false);
  const auto log = columns(shell.read("forces.csv"));
  EXPECT_EQ(log.begin()->second.size(), run["steps"]) << "every step is written down";
  for (const char* name : {"fx", "fy", "fz"}) {
    ASSERT_TRUE(log.contains(name));
    for (const std::string& force : log.at(name)) {
      ASSERT_TRUE(std::isfinite(std::strtod(force.c_str(), nullptr)));
    }
  }
}

// Planning takes a first look at it, which takes nothing from it.
TEST(LiveProgram, RecordingsBeginTogetherWhenTheRunDoes) {
  if (test::effort(2) < 2)
    GTEST_SKIP() << "a slow build may miss frames of a recording in real time";
  Shell shell;
  for (const std::string name : {"a", "b"}) {
    std::filesystem::create_directory(shell.path(name));
    shell.write(name + "/sequence.json",
                R"({"fx": 60, "fy": 60, "cx": 31.5, "cy": 23.5, "fps": 2})");
    for (int i = 0; i < 4; ++i) {
      std::string image = "P5 64 48 65535\n";
      for (int k = 0; k < 64 * 48; ++k) image += {'\x02', static_cast<char>(i + k % 7)};
      shell.write(fmt::format("{}/{}.pgm", name, i), image);
    }
  }
  const Outcome outcome = shell.run("touch sequence:a sequence:b --duration 2 --json run.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json run = Json::parse(shell.read("run.json"));
  ASSERT_EQ(run["sources"].size(), 2u);
  for (const Json& source : run["sources"]) {
    EXPECT_EQ(source["frames"], 4) << "the first one, too: it was looked at before";
    EXPECT_EQ(source["drops"]["late"], 0);
  }
}

TEST(LiveProgram, EndsWithItsReportWhenInterrupted) {
  Shell shell;
  const int status = std::system(
      fmt::format(
          "cd '{}'; '{}' touch camera:simulated --duration 100 --json run.json > out 2> err "
          "& p=$!; until grep -qs Hz err; do sleep 0.1; kill -0 $p || break; done; "
          "kill -INT $p; wait $p",
          shell.path("."), PALPATE_PROGRAM)
          .c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << shell.read("err");
  EXPECT_NE(shell.read("out").find("Ctrl-C"), std::string::npos);
  const Json run = Json::parse(shell.read("run.json"));
  EXPECT_EQ(run["interrupted"], true);
  EXPECT_GT(run["steps"], 10);
}

TEST(LiveProgram, GuardAndServoAreAsTheSetUpSays) {
  if (too_slow_for_cameras()) GTEST_SKIP() << "no surface is ready in time";
  Shell shell;
  std::string way = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < 7500; ++i) {  // down once there is a surface, on a slow machine too
    const int down = std::max(0, i - 6000);
    way += fmt::format("{},0,0,{}\n", 1e-3 * i, std::max(-4e-3, 0.02 - 1e-4 * down));
  }
  shell.write("way.csv", way);
  shell.write("live.toml",
              "[[source]]\nfrom = \"camera:simulated:still\"\n"
              "[hand]\ntrajectory = \"way.csv\"\n"
              "[guard]\nmaximum_force = 0.5\nslew = 50\nwatchdog = 0.1\n"
              "[servo]\nprocessor = 1023\nrealtime = false\nlock_memory = false\n");
  const Outcome outcome = shell.run("touch --setup live.toml --json run.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json run = Json::parse(shell.read("run.json"));
  const Json& guard = run["live"]["guard"];
  EXPECT_EQ(guard["maximum_force_N"], 0.5);
  EXPECT_EQ(guard["slew_N_per_s"], 50);
  EXPECT_EQ(guard["watchdog_s"], 0.1);
  EXPECT_GT(guard["clamped"], 0) << "500 N/m and 4 mm are 2 N";
  EXPECT_LE(run["largest_force_N"].get<double>(), 0.5 + 1e-9);
  EXPECT_GT(run["largest_force_N"].get<double>(), 0.4);
  ASSERT_EQ(run["live"]["realtime"].size(), 2u) << "nothing else was asked for";
  EXPECT_EQ(run["live"]["realtime"][0]["what"], "pinned to processor 1023");
  EXPECT_EQ(run["live"]["realtime"][1]["what"], "processor 1023 reserved for the servo");
}

TEST(LiveProgram, RefusesRatesThatNoServoKeepsInRealTime) {
  Shell shell;
  const Outcome outcome = shell.run("touch camera:simulated --rate 100");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("between 500 and 10000"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace palpate::app
