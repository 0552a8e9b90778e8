// Bags as sources of palpate, as a user runs it: one that others' writer made, and ours.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "bag/bags.hpp"
#include "support/contains.hpp"

namespace palpate::bag {
namespace {

using app::Outcome;
using app::Shell;
using nlohmann::json;
using test::contains;

class BagSource : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("node --version >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "node is absent (Debian: nodejs)";
    }
    if (!std::filesystem::exists(PALPATE_PEER "/node_modules/.package-lock.json")) {
      GTEST_SKIP() << "tests/peer/node_modules is absent: run npm ci in tests/peer";
    }
  }

  // 2 s at 30 Hz of a plane 0.5 m away: tests/peer/camera.mjs.
  void record(const std::string& kind) const {
    const std::string command = fmt::format("node {}/camera.mjs {} {} 2>{}", PALPATE_PEER,
                                            shell_.path("camera.mcap"), kind, shell_.path("err"));
    ASSERT_EQ(std::system(command.c_str()), 0) << shell_.read("err");
  }

  // A hand that stays 2 mm inside the plane, for 2 s.
  void press() const {
    std::string way = "t,hip_x,hip_y,hip_z\n0,0,0,0.48\n0.2,0,0,0.48\n0.3,0,0,0.502\n2,0,0,0.502\n";
    shell_.write("way.csv", way);
  }

  Shell shell_;
};

TEST_F(BagSource, IsFeltAsItWasRecordedHoweverItIsPacked) {
  press();
  std::string first;
  for (const std::string kind : {"none", "lz4", "zstd"}) {
    record(kind);
    const Outcome outcome = shell_.run(
        "touch bag:camera.mcap --simulated-time --trajectory way.csv --log log.csv "
        "--json report.json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json report = json::parse(shell_.read("report.json"));
    const json& source = report["sources"][0];
    EXPECT_EQ(source["name"], "camera");
    EXPECT_GE(source["frames_touchable"], 59);
    EXPECT_NEAR(source["rate_Hz"].get<double>(), 30, 0.5);
    EXPECT_NEAR(report["largest_force_N"].get<double>(), 1, 0.25) << "500 N/m, 2 mm deep";
    const std::string log = app::without_times(shell_, "log.csv");
    if (first.empty()) first = log;
    EXPECT_EQ(log, first) << kind;
  }
}

TEST_F(BagSource, IsPlacedByItsTransforms) {
  record("zstd");
  const std::string play =
      "touch bag:camera.mcap:/camera/depth/image_rect_raw,frame=odom --simulated-time --duration 1 "
      "--json -";
  const Outcome outcome = shell_.run(play);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json source = json::parse(outcome.out)["sources"][0];
  EXPECT_GE(source["frames_touchable"], 28);
  const Outcome nowhere =
      shell_.run("touch bag:camera.mcap,frame=moon --simulated-time --duration 0.2");
  EXPECT_NE(nowhere.code, 0);
  EXPECT_TRUE(contains(nowhere.err, "moon")) << nowhere.err;
}

TEST_F(BagSource, IsToldOfAndDescribedInASetUpFile) {
  record("lz4");
  const Outcome told = shell_.run("info bag:camera.mcap");
  ASSERT_EQ(told.code, 0) << told.err;
  EXPECT_TRUE(contains(told.out, "160 x 120")) << told.out;
  shell_.write("desk.toml",
               "[[source]]\nfrom = \"bag:camera.mcap\"\nname = \"desk\"\nloop = true\n");
  const Outcome run = shell_.run("touch --setup desk.toml --simulated-time --duration 3 --json -");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_GE(json::parse(run.out)["sources"][0]["frames_touchable"], 85);
}

TEST_F(BagSource, ThatWasCutIsFeltAsFarAsItGoes) {
  record("zstd");
  const std::string path = shell_.path("camera.mcap");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Outcome outcome =
      shell_.run("touch bag:camera.mcap --simulated-time --duration 2 --json -");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json source = json::parse(outcome.out)["sources"][0];
  EXPECT_GE(source["frames_touchable"], 15);
  EXPECT_LT(source["frames_touchable"], 40);
}

TEST(BagSourceErrors, NameWhatIsThere) {
  Shell shell;
  {
    McapWriter writer(shell.path("poses.mcap"));
    write_poses(writer, 1, 10);
  }
  const Outcome none = shell.run("touch bag:poses.mcap --simulated-time --duration 1");
  EXPECT_EQ(none.code, 1);
  EXPECT_TRUE(contains(none.err, "neither depth images")) << none.err;
  EXPECT_TRUE(contains(none.err, "palpate bag info")) << none.err;
  const Outcome absent = shell.run("touch bag:absent.mcap --simulated-time --duration 1");
  EXPECT_EQ(absent.code, 1);
  EXPECT_TRUE(contains(absent.err, "absent.mcap")) << absent.err;
  EXPECT_EQ(shell.run("touch bag: --simulated-time").code, 2);
}

}  // namespace
}  // namespace palpate::bag
