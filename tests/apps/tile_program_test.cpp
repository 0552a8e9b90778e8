// palpate tile says what it wrote, and refuses with words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

TEST(TileProgram, WritesAStoreAndSaysSo) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const Outcome outcome = shell.run("tile plane.xyz --out store --json report.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Potree 2.0"));
  const auto report = nlohmann::json::parse(shell.read("report.json"));
  EXPECT_GT(report["points"], 100);
  EXPECT_EQ(report["octree_bytes"], 12 * report["points"].get<int>());
  EXPECT_EQ(nlohmann::json::parse(shell.read("store/metadata.json"))["points"], report["points"]);
  EXPECT_FALSE(std::filesystem::exists(shell.path("store/unfinished")));
}

TEST(TileProgram, RefusesWhatIsCompleteAndWhatIsNoCloud) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  ASSERT_EQ(shell.run("tile plane.xyz --out store").code, 0);
  const Outcome again = shell.run("tile plane.xyz --out store");
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.err, HasSubstr("store is complete; --force replaces it"));
  EXPECT_EQ(shell.run("tile plane.xyz --out store --force").code, 0);
  const Outcome absent = shell.run("tile absent.laz --out other");
  EXPECT_EQ(absent.code, 1);
  EXPECT_THAT(absent.err, HasSubstr("absent.laz: no such file"));
  EXPECT_EQ(shell.run("tile plane.xyz --out other --json plane.xyz").code, 2);
}

}  // namespace
}  // namespace palpate::app
