#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/palpate/run/touch_statistics.hpp"
#include "apps/program.hpp"

namespace palpate::app {
namespace {

using Eigen::Vector3d;

constexpr double kPressed = 500;  // N/m

// A hand at `depth` (m) in a surface that looks up.
ServoState pressed(int index, double depth) {
  ServoState step;
  step.time = 1e-3 * index;
  step.hip = {0, 0, -depth};
  step.contact.touching = depth > 0;
  if (depth <= 0) return step;
  step.contact.normal = Vector3d::UnitZ();
  step.contact.stiffness = kPressed;
  step.force = {0, 0, kPressed * depth};
  return step;
}

TEST(Unguarded, CountsNothingThatTheHandDoesItself) {
  DeviceInfo device;
  device.maximum_force = 10;
  Unguarded run(GuardOptions{}, device, 1);
  for (int i = 0; i < 40; ++i) run.add(pressed(i, 1e-3 * (i < 20 ? i - 5 : 34 - i)));
  EXPECT_EQ(run.counts().slewed, 0u);
  EXPECT_EQ(run.limits().maximum_force, 8);
  EXPECT_EQ(run.counts().clamped, 0u);  // 7 N
}

TEST(Unguarded, CountsTheStepsInWhichASlewWouldHaveFollowedAForceThatVanishes) {
  for (const double scale : {1., 10.}) {
    Unguarded run(GuardOptions{}, {}, scale);
    for (int i = 0; i < 20; ++i) run.add(pressed(i, 4e-4 * i));
    ServoState fallen = pressed(20, 0);
    fallen.hip = {0, 0, -4e-4 * 19};
    for (int i = 20; i < 60; ++i) {
      run.add(fallen);
      fallen.time += 1e-3;
    }
    EXPECT_EQ(run.counts().slewed, 12u);  // 3.8 N at 0.3 N a step; the last one is whole
    EXPECT_NEAR(run.largest_change(), 3.8, 1e-12);
  }
}

TEST(Unguarded, TakesTheLimitsOfASetUpAndCountsWhatIsAboveTheMaximum) {
  GuardOptions guard;
  guard.maximum_force = 2;
  guard.slew = 1e6;
  Unguarded run(guard, {}, 1);
  for (int i = 0; i <= 10; ++i) run.add(pressed(i, 1e-3 * i));
  EXPECT_EQ(run.counts().clamped, 6u);
  EXPECT_EQ(run.counts().slewed, 0u);
}

TEST(Unguarded, IsToldInReportsOfSimulatedTimeAlone) {
  Shell shell;
  const Outcome good = shell.run("touch synthetic:bumps --duration 0.5 --json report.json");
  ASSERT_EQ(good.code, 0) << good.err;
  EXPECT_NE(good.out.find("guard      none in simulated time; it would not have intervened"),
            std::string::npos)
      << good.out;
  const auto report = nlohmann::json::parse(shell.read("report.json"));
  EXPECT_EQ(report["unguarded"]["would_slow_steps"], 0);
  EXPECT_EQ(report["unguarded"]["slew_N_per_s"], 300);
  EXPECT_EQ(report["unguarded"]["maximum_force_N"], 16);
}

TEST(Unguarded, AHandThatFallsOffAnEdgeIsToldTwice) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  std::string way = "t,hip_x,hip_y,hip_z\n";
  for (int i = 0; i < 600; ++i) {
    way += fmt::format("{},{},0,{}\n", 1e-3 * i, std::max(0, i - 100) * 1e-4,
                       std::max(-3e-3, 0.01 - 1.3e-4 * i));
  }
  shell.write("way.csv", way);
  const Outcome outcome = shell.run("touch plane.xyz --trajectory way.csv --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("steps (largest 1.5 N in a step)"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("notes      1 (0.167 % of steps): contact was lost"),
            std::string::npos)
      << outcome.out;
  const auto report = nlohmann::json::parse(shell.read("report.json"));
  EXPECT_GE(report["unguarded"]["would_slow_steps"], 3);
  EXPECT_NEAR(report["unguarded"]["largest_slowed_step_N"].get<double>(), 1.5, 0.05);
  EXPECT_TRUE(report["unguarded"]["maximum_force_N"].is_null());
  EXPECT_EQ(report["notes"][0]["note"], "fell");
}

}  // namespace
}  // namespace palpate::app
