// What the program makes of an E57 file with several scans.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/touch_plan.hpp"
#include "apps/program.hpp"
#include "apps/setup_parsed.hpp"
#include "io/e57_bytes.hpp"

namespace palpate::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// `count` scans of the plane z = 0 by scanners 1 m above it, which look down: 6 x 6 cm each, one
// 4 cm from the next.
std::string floor_e57(int count) {
  std::vector<E57TestScan> scans;
  for (int scan = 0; scan < count; ++scan) {
    std::vector<std::int64_t> x;
    std::vector<std::int64_t> y;
    for (int i = 0; i < 31 * 31; ++i) {
      x.push_back(2 * (i % 31) - 30);
      y.push_back(2 * (i / 31) - 30);
    }
    scans.push_back({{e57_scaled("cartesianX", -30, 30, 0.001, 0, x),
                      e57_scaled("cartesianY", -30, 30, 0.001, 0, y),
                      e57_doubles("cartesianZ", std::vector<double>(x.size(), 1))},
                     e57_pose({0, 1, 0, 0}, {0.04 * scan, 0, 1}),
                     "setup"});
  }
  return E57TestFile(scans).bytes();
}

std::vector<std::string> paths_of(const TouchPlan& plan) {
  std::vector<std::string> paths;
  for (const SourcePlan& source : plan.sources) paths.push_back(source.argument.path);
  return paths;
}

TEST(Scans, EachOfAFileIsASourceOfItsOwn) {
  Shell shell;
  shell.write("house.e57", floor_e57(3));
  const Outcome outcome = shell.run("touch house.e57 --duration 0.5 --json run.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json sources = nlohmann::json::parse(shell.read("run.json"))["sources"];
  ASSERT_EQ(sources.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(sources[i]["name"], fmt::format("house-{}", i + 1));
    EXPECT_EQ(sources[i]["file"], fmt::format("house.e57#{}", i + 1));
    EXPECT_EQ(sources[i]["format"], fmt::format("E57, scan {} of 3 \"setup\"", i + 1));
    EXPECT_EQ(sources[i]["points_read"], 961);
  }
}

TEST(Scans, InfoTellsOfEachAndWhereItsScannerStood) {
  Shell shell;
  shell.write("house.e57", floor_e57(2));
  const Outcome outcome = shell.run("info house.e57");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("house-1 house.e57#1"));
  EXPECT_THAT(outcome.out, HasSubstr("viewpoint  0, 0, 1\n"));
  EXPECT_THAT(outcome.out, HasSubstr("house-2 house.e57#2"));
  EXPECT_THAT(outcome.out, HasSubstr("viewpoint  0.04, 0, 1\n"));
}

TEST(Scans, APoseOfTheFileIsOfAllItsScans) {
  const Shell shell;
  const std::string file = shell.path("house.e57");
  shell.write("house.e57", floor_e57(2));
  const TouchPlan plan =
      planned(file + " table=synthetic:table --pose house=1,2,3,0,0,0,1 --simulated-time");
  EXPECT_THAT(paths_of(plan), ElementsAre(file + "#1", file + "#2", "synthetic:table"));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(plan.sources[i].options.T_world_sensor.translation(), Eigen::Vector3d(1, 2, 3));
  }
  EXPECT_TRUE(plan.sources[2].options.T_world_sensor.translation().isZero());
}

TEST(Scans, AScanMayHaveAPoseOfItsOwn) {
  const Shell shell;
  shell.write("house.e57", floor_e57(2));
  const std::string house = shell.path("house.e57");
  const TouchPlan plan =
      planned(house + " --pose house-2=1,2,3,0,0,0,1 --pose house=4,0,0,0,0,0,1");
  EXPECT_EQ(plan.sources[0].options.T_world_sensor.translation(), Eigen::Vector3d(4, 0, 0));
  EXPECT_EQ(plan.sources[1].options.T_world_sensor.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_THROW((void)planned(house + " --pose house-3=1,2,3,0,0,0,1"), UsageError);
}

TEST(Scans, AreJoinedWhereASceneHasNoRoomForThem) {
  Shell shell;
  shell.write("nine.e57", floor_e57(9));
  const Outcome outcome = shell.run("touch nine.e57 --duration 0.2");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("nine nine.e57 (E57, 9 scans joined)"));

  shell.write("eight.e57", floor_e57(8));
  const std::string eight = shell.path("eight.e57");
  EXPECT_EQ(planned(eight).sources.size(), 8U);
  EXPECT_THAT(paths_of(planned(eight + " synthetic:table")), ElementsAre(eight, "synthetic:table"));
}

TEST(Scans, OneCanBeNamedByItsNumber) {
  Shell shell;
  shell.write("house.e57", floor_e57(3));
  const Outcome outcome = shell.run("info 'house.e57#2'");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("scan 2 of 3"));
  const Outcome absent = shell.run("touch 'house.e57#5'");
  EXPECT_EQ(absent.code, 1);
  EXPECT_THAT(absent.err, HasSubstr("house.e57#5: there are 3 scans"));
  const Outcome same = shell.run("touch 'house.e57#2' --json house.e57");
  EXPECT_EQ(same.code, 2);
  EXPECT_THAT(same.err, HasSubstr("the same file"));
}

TEST(Scans, APageOpensAllOfThem) {
  const Shell shell;
  const std::string file = shell.path("house.e57");
  shell.write("house.e57", floor_e57(3));
  const TouchPlan plan = plan_of_file(planned("synthetic:sphere --view --scale 0.5"), file);
  EXPECT_THAT(paths_of(plan), ElementsAre(file + "#1", file + "#2", file + "#3"));
  EXPECT_EQ(plan.sources[2].reading.scale, 0.5);
}

}  // namespace
}  // namespace palpate::app
