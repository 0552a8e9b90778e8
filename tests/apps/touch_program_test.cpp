#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

constexpr const char* kFirstColumns = "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,fx,fy,fz,us,";

double largest_push(const Shell& shell, const std::string& name) {
  auto log = columns(shell.read(name));
  double largest = 0;
  for (const std::string& force : log["fz"]) largest = std::max(largest, number(force));
  return largest;
}

TEST(Touch, ExploresASyntheticCloudAndReports) {
  Shell shell;
  const Outcome outcome =
      shell.run("touch synthetic:bumps --duration 3 --log log.csv --json report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word : {"points", "spacing", "R ", "prepared", "p99.9", "contacts", "energy"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(outcome.out.find('\033'), std::string::npos);
  EXPECT_EQ(shell.read("log.csv").find(kFirstColumns), 0u);
  const auto report = nlohmann::json::parse(shell.read("report.json"));
  EXPECT_EQ(report["steps"], columns(shell.read("log.csv"))["t"].size());
  EXPECT_NEAR(report["simulated_s"].get<double>(), 3, 0.01);
  EXPECT_GT(report["contacts"].get<int>(), 0);
  EXPECT_GT(report["largest_force_N"].get<double>(), 0.3);
  EXPECT_LT(report["largest_force_N"].get<double>(), 6);
  EXPECT_EQ(report["sources"][0]["points_read"], 10000);
  EXPECT_GT(report["computing_us"]["p50"].get<double>(), 0);
}

TEST(Touch, SameInputTwiceGivesTheSameLogBitForBit) {
  Shell shell;
  const std::string arguments =
      "touch synthetic:table --duration 1.5 --friction-static 0.4 --friction-dynamic 0.3 "
      "--texture-amplitude 0.0001 --log ";
  ASSERT_EQ(shell.run(arguments + "a.csv").code, 0);
  ASSERT_EQ(shell.run(arguments + "b.csv").code, 0);
  const std::string a = without_times(shell, "a.csv");
  EXPECT_GT(a.size(), 10000u);
  EXPECT_TRUE(a == without_times(shell, "b.csv"));
}

TEST(Touch, TrajectoryIsPlayedRowByRowAndForceIsStiffnessTimesStretch) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const Outcome outcome =
      shell.run("touch plane.xyz --trajectory way.csv --stiffness 400 --log log.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto way = columns(press_and_slide());
  auto log = columns(shell.read("log.csv"));
  ASSERT_EQ(log["t"].size(), way["t"].size());
  double largest = 0;
  for (std::size_t i = 0; i < log["t"].size(); ++i) {
    for (const char* name : {"t", "hip_x", "hip_y", "hip_z"}) {
      EXPECT_EQ(number(log[name][i]), number(way[name][i]));
    }
    const double stretch = number(log["proxy_z"][i]) - number(log["hip_z"][i]);
    EXPECT_NEAR(number(log["fz"][i]), 400 * stretch, 1e-12);
    largest = std::max(largest, number(log["fz"][i]));
  }
  EXPECT_NEAR(largest, 400 * 3e-3, 0.02);
  EXPECT_EQ(number(log["fz"].front()), 0);
  EXPECT_EQ(number(log["fz"].back()), 0);
}

TEST(Touch, LogIsATrajectoryAgain) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  ASSERT_EQ(shell.run("touch plane.xyz --trajectory way.csv --log a.csv").code, 0);
  ASSERT_EQ(shell.run("touch plane.xyz --trajectory a.csv --log b.csv").code, 0);
  EXPECT_TRUE(without_times(shell, "a.csv") == without_times(shell, "b.csv"));
}

TEST(Touch, StandardInputIsACloud) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  ASSERT_EQ(shell.run("touch - --trajectory way.csv --log a.csv", plane_xyz()).code, 0);
  ASSERT_EQ(shell.run("touch plane.xyz --trajectory way.csv --log b.csv").code, 0);
  EXPECT_TRUE(without_times(shell, "a.csv") == without_times(shell, "b.csv"));
}

TEST(Touch, PoseAndScalePlaceACloudInTheWorld) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const Outcome up =
      shell.run("touch p=plane.xyz --pose p=0,0,0.002,0,0,0,1 --trajectory way.csv --log up.csv");
  ASSERT_EQ(up.code, 0) << up.err;
  EXPECT_NEAR(largest_push(shell, "up.csv"), 500 * 5e-3, 0.05);

  std::string millimetres;
  for (int i = 0; i < 31 * 31; ++i) {
    millimetres += fmt::format("{} {} 0\n", 2 * (i % 31 - 15), 2 * (i / 31 - 15));
  }
  shell.write("mm.xyz", millimetres);
  ASSERT_EQ(shell.run("touch mm.xyz --scale 0.001 --trajectory way.csv --log mm.csv").code, 0);
  EXPECT_NEAR(largest_push(shell, "mm.csv"), 500 * 3e-3, 0.02);
}

TEST(Touch, ExplorationCanBeScripted) {
  Shell shell;
  const Outcome outcome =
      shell.run("touch synthetic:sphere --duration 2 --device scripted --json r.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(shell.read("r.json"));
  EXPECT_EQ(report["device"]["name"], "scripted");
  EXPECT_NEAR(report["largest_force_N"].get<double>(),
              500 * report["device"]["depth_m"].get<double>(), 0.3);
}

TEST(Touch, SeveralCloudsAreOneScene) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const Outcome outcome = shell.run(
      "touch low=plane.xyz plane.xyz --pose low=0,0,-0.05,0,0,0,1 --trajectory way.csv --json "
      "r.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(shell.read("r.json"));
  EXPECT_EQ(report["sources"].size(), 2u);
  EXPECT_EQ(report["sources"][1]["name"], "plane");
  EXPECT_NEAR(report["largest_force_N"].get<double>(), 1.5, 0.03);
}

TEST(Touch, SoftStiffnessFollowsTheIntensity) {
  Shell shell;
  shell.write("plane.ply", plane_ply_with_intensity());
  // From x = -3 cm to 3 cm the material goes from 0 to 1.
  for (const double x : {-0.01, 0.01}) {
    shell.write("way.csv", fmt::format("t,hip_x,hip_y,hip_z\n0,{0},0,0.01\n1,{0},0,-0.002\n", x));
    const Outcome outcome =
        shell.run("touch plane.ply --soft-stiffness 100 --trajectory way.csv --log log.csv");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const double share = (x + 0.03) / 0.06;
    EXPECT_NEAR(number(columns(shell.read("log.csv"))["stiffness"][1]), 100 + 400 * share, 5);
  }
}

TEST(Touch, SoftFrictionFollowsTheIntensity) {
  Shell shell;
  shell.write("plane.ply", plane_ply_with_intensity());
  double pull[2] = {};
  for (const int side : {0, 1}) {
    // Pressed 2 mm deep and drawn along y until the proxy slides, where the material is 1/6 or 5/6.
    std::string way = "t,hip_x,hip_y,hip_z\n";
    const double x = side == 0 ? -0.02 : 0.02;
    for (int i = 0; i < 200; ++i) {
      way += fmt::format("{},{},{},{}\n", 1e-3 * i, x, 1e-4 * std::max(0, i - 100) - 5e-3,
                         i < 100 ? 8e-3 - 1e-4 * i : -2e-3);
    }
    shell.write("way.csv", way);
    const Outcome outcome = shell.run(
        "touch plane.ply --soft-friction 0.1 --friction-dynamic 0.4 --friction-static 0.4 "
        "--trajectory way.csv --log log.csv");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    auto log = columns(shell.read("log.csv"));
    pull[side] = -number(log["fy"].back()) / number(log["fz"].back());
  }
  EXPECT_NEAR(pull[0], 0.4 * (0.1 + 0.9 / 6), 0.02);
  EXPECT_NEAR(pull[1], 0.4 * (0.1 + 0.9 * 5 / 6), 0.02);
}

TEST(Touch, SoftStiffnessIsAShareOfTheStiffnessThatWasPlanned) {
  Shell shell;
  shell.write("plane.ply", plane_ply_with_intensity());
  // 60 m across: K is chosen for the hand's scale, far below 500.
  const std::string explore = "touch plane.ply --scale 1000 --duration 4 --log log.csv ";
  ASSERT_EQ(shell.run(explore + "--json r.json").code, 0);
  const auto report = nlohmann::json::parse(shell.read("r.json"));
  const double hard = report["stiffness_N_per_m"].get<double>();
  ASSERT_LT(hard, 100);
  ASSERT_EQ(shell.run(explore + fmt::format("--soft-stiffness {}", 0.2 * hard)).code, 0);
  double smallest = hard;
  auto log = columns(shell.read("log.csv"));
  for (const std::string& k : log["stiffness"]) {
    if (number(k) > 0) smallest = std::min(smallest, number(k));
  }
  EXPECT_GE(smallest, 0.2 * hard * (1 - 1e-6));
  EXPECT_LT(smallest, 0.9 * hard);
  const Outcome outcome = shell.run(explore + "--soft-stiffness 100");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--soft-stiffness"), std::string::npos) << outcome.err;
}

TEST(Touch, SimulatedHandIsPulledAlongATrajectory) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", press_and_slide());
  const Outcome outcome =
      shell.run("touch plane.xyz --trajectory way.csv --device simulated --log log.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  auto log = columns(shell.read("log.csv"));
  // Hand (300 N/m) and surface (500 N/m) share the 3 mm.
  EXPECT_NEAR(number(log["fz"][290]), 500 * 3e-3 * 300 / 800, 0.03);
  EXPECT_NEAR(number(log["hip_y"][290]), 3e-4, 1e-4);
}

TEST(Touch, SimulatedHandOfATrajectoryWithOneRowTakesOneStep) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  shell.write("way.csv", "t,hip_x,hip_y,hip_z\n100,0,0,0.01\n");
  const Outcome outcome =
      shell.run("touch plane.xyz --trajectory way.csv --device simulated --log log.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(columns(shell.read("log.csv"))["t"].size(), 1u);
}

TEST(Touch, PresetPaperAndEveryFieldRun) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  for (const char* more : {"--preset paper", "--preset paper --field pointset", "--field metaball",
                           "--field pointset", "--kernel wendland", "--tool-radius 0.003",
                           "--voxel 0.004", "--radius 0.01 --threshold 0.5"}) {
    const Outcome outcome =
        shell.run(fmt::format("touch synthetic:sphere --duration 1 --json r.json {}", more));
    EXPECT_EQ(outcome.code, 0) << more << "\n" << outcome.err;
    const auto report = nlohmann::json::parse(shell.read("r.json"));
    EXPECT_GT(report["largest_force_N"].get<double>(), 0.1) << more;
  }
}

TEST(Touch, LogAndReportCanGoToStandardOutput) {
  Shell shell;
  const Outcome json = shell.run("touch synthetic:sheet --duration 0.2 --json -");
  ASSERT_EQ(json.code, 0) << json.err;
  EXPECT_TRUE(nlohmann::json::accept(json.out));
  const Outcome log = shell.run("touch synthetic:sheet --duration 0.2 --log -");
  EXPECT_EQ(log.out.find(kFirstColumns), 0u);
  EXPECT_NE(log.err.find("contacts"), std::string::npos);
}

TEST(Touch, PictureIsDrawnOrSaysWhatIsMissing) {
  for (const char* cloud : {"bumps", "room"}) {  // shown whole; of which the contact is a part
    Shell shell;
    const Outcome outcome = shell.run(
        fmt::format("touch synthetic:{} --duration 1 --picture a.png --log log.csv", cloud));
    if (outcome.code == 0) {
      EXPECT_EQ(shell.read("a.png").substr(1, 3), "PNG");
    } else {
      EXPECT_EQ(outcome.code, 1);
      EXPECT_NE(outcome.err.find("python3-matplotlib"), std::string::npos) << outcome.err;
    }
  }
}

TEST(Touch, PictureThatCannotBeDrawnIsToldBeforeTheRun) {
  Shell shell;
  const Outcome outcome = shell.run(
      "touch synthetic:bumps --duration 1 --picture a.png --log a.csv", "", "PYTHONHOME=/nowhere");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("python3-matplotlib"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(shell.path("a.csv")));
}

}  // namespace
}  // namespace palpate::app
