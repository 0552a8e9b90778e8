// What the program makes of clouds that stay on disk.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/program.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

/// A folder with terrain of 200 000 points in `site`.
struct Site {
  Site() {
    const Outcome made = shell.run("tile synthetic:terrain:200000 --out site");
    EXPECT_EQ(made.code, 0) << made.err;
  }

  Shell shell;
};

TEST(Stores, ThatAreLargerThanTheCacheAreReadAroundTheTool) {
  Site site;
  const Outcome run =
      site.shell.run("touch site --cache 8M --duration 0.5 --json run.json --log a.csv");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("200 000 points on disk"));
  const nlohmann::json source = nlohmann::json::parse(site.shell.read("run.json"))["sources"][0];
  EXPECT_EQ(source["points_stored"], 200'000);
  EXPECT_EQ(source["format"], "Potree 2.0, DEFAULT, in metres");
  EXPECT_GT(source["points_felt"], 1000);
  EXPECT_FALSE(source.contains("prepared_share"));
  if (test::is_slow_build()) return;  // the second run is of the same code
  ASSERT_EQ(site.shell.run("touch site --cache 8M --duration 0.5 --log b.csv").code, 0);
  EXPECT_EQ(without_times(site.shell, "a.csv"), without_times(site.shell, "b.csv"));
}

TEST(Stores, ThatFitAreReadAsAWhole) {
  Site site;
  const Outcome run = site.shell.run("touch site/metadata.json --duration 0.2 --json run.json");
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json source = nlohmann::json::parse(site.shell.read("run.json"))["sources"][0];
  EXPECT_FALSE(source.contains("points_stored"));
  EXPECT_EQ(source["points_read"], 200'000);
}

// What a log says of the hand's way and of forces.
struct Log {
  explicit Log(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (cells.size() < 10) continue;
      way += fmt::format("{},{},{},{}\n", cells[0], cells[1], cells[2], cells[3]);
      if (cells[7] == "fx") continue;
      forces.emplace_back(std::stod(cells[7]), std::stod(cells[8]), std::stod(cells[9]));
    }
  }

  std::string way;
  std::vector<Eigen::Vector3d> forces;  // N
};

TEST(Stores, AreFeltInPartsAsAWholeWithTheSameRadiusAndVoxel) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Site site;
  const auto log = [&](const std::string& options) {
    const Outcome run = site.shell.run("touch site --log log.csv " + options);
    EXPECT_EQ(run.code, 0) << run.err;
    return std::pair(run.out, Log(site.shell.read("log.csv")));
  };
  site.shell.write("way.csv", log("--duration 1").second.way);
  const std::string both = "--trajectory way.csv --simulated-time --radius 0.4 --voxel 0.2 ";
  const auto [told, parts] = log(both + "--cache 8M");
  const Log whole = log(both).second;
  EXPECT_THAT(told, testing::Not(HasSubstr("--voxel make it")));
  ASSERT_EQ(parts.forces.size(), whole.forces.size());
  double largest = 0;
  double difference = 0;
  for (std::size_t i = 0; i < whole.forces.size(); ++i) {
    largest = std::max(largest, whole.forces[i].norm());
    difference = std::max(difference, (whole.forces[i] - parts.forces[i]).norm());
  }
  EXPECT_GT(largest, 1);
  EXPECT_LT(difference, 1e-6 * largest);
  const auto alone = log("--trajectory way.csv --simulated-time --radius 0.4 --cache 8M").first;
  EXPECT_THAT(alone, HasSubstr("--radius and --voxel make it as the same points in memory"));
}

TEST(Stores, SayWhatNeedsTheWhole) {
  Site site;
  const Outcome record = site.shell.run("touch site --cache 8M --record run.mcap --duration 0.2");
  EXPECT_EQ(record.code, 1);
  EXPECT_THAT(record.err, HasSubstr("--record needs all of site in memory"));
  const Outcome length = site.shell.run("touch site --cache 8M --length 3 --duration 0.2");
  EXPECT_EQ(length.code, 1);
  EXPECT_THAT(length.err, HasSubstr("--length needs all of site in memory"));
}

TEST(Stores, AreGuessedAndRefusedAsOtherClouds) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Site site;
  const Outcome moved = site.shell.run(
      "touch site --cache 8M --pose site=100000,0,0,0,0,0,1 --duration 0.1 --json run.json");
  ASSERT_EQ(moved.code, 0) << moved.err;
  EXPECT_THAT(moved.out, testing::Not(HasSubstr("survey coordinates")));
  const Outcome large = site.shell.run("touch site --cache 8M --scale 1e9 --duration 0.1");
  EXPECT_EQ(large.code, 1);
  EXPECT_THAT(large.err, HasSubstr("are --scale and --pose right?"));
}

TEST(Stores, TellASizeThatIsNone) {
  Shell shell;
  for (const std::string size : {"", "0", "x", "-1", "99999999999G"}) {
    const Outcome run = shell.run("touch synthetic:sphere --cache '" + size + "'");
    EXPECT_EQ(run.code, 2) << size;
    EXPECT_THAT(run.err, HasSubstr("is no size; give 500M or 2G")) << size;
  }
}

}  // namespace
}  // namespace palpate::app
