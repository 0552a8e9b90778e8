#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "apps/recorded_wall.hpp"

namespace palpate::app {
namespace {

TEST(Organised, DepthImageGoesThroughTheDepthFilterUnlessUnorganised) {
  Shell shell;
  shell.write("wall.pgm", wall_pgm(0));
  shell.write("way.csv", "t,hip_x,hip_y,hip_z\n0,0,0,0.48\n0.1,0,0,0.503\n0.2,0,0,0.503\n");
  const std::string command =
      "touch wall.pgm --intrinsics 60,60,31.5,23.5 --trajectory way.csv --log log.csv ";
  for (const char* more : {"", "--unorganised"}) {
    const Outcome outcome = shell.run(command + more);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(number(columns(shell.read("log.csv"))["fz"].back()), -500 * 3e-3, 0.05) << more;
    EXPECT_EQ(outcome.out.find("voxel") == std::string::npos, std::string(more).empty());
  }
  EXPECT_NE(shell.run("touch wall.pgm").err.find("--intrinsics"), std::string::npos);
}

// The wall as an organised cloud, with a hole.
TEST(Organised, OrganisedCloudGoesThroughTheDepthFilterUnlessUnorganised) {
  Shell shell;
  std::string cloud =
      "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 64\nHEIGHT 48\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3072\nDATA ascii\n";
  for (int i = 0; i < 64 * 48; ++i) {
    const double z = i < 200 ? std::nan("") : 0.5;
    cloud += fmt::format("{} {} {}\n", (i % 64 - 31.5) * z / 60, (i / 64 - 23.5) * z / 60, z);
  }
  shell.write("wall.pcd", cloud);
  shell.write("way.csv", "t,hip_x,hip_y,hip_z\n0,0,0,0.48\n0.1,0,0,0.503\n0.2,0,0,0.503\n");
  const auto felt_as_image = [&](const std::string& more) {
    const Outcome outcome =
        shell.run("touch wall.pcd --trajectory way.csv --log log.csv --json r.json " + more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(number(columns(shell.read("log.csv"))["fz"].back()), -500 * 3e-3, 0.05) << more;
    const bool said =
        outcome.out.find("64 x 48 pixels, focal length 60 px, processed as a depth frame") !=
        std::string::npos;
    EXPECT_EQ(Json::parse(shell.read("r.json"))["sources"][0].contains("organised"), said);
    return said;
  };
  EXPECT_TRUE(felt_as_image(""));
  EXPECT_TRUE(felt_as_image("--noise xtion --nearest 0.2 --radius 0.1"));
  for (const char* more : {"--unorganised", "--voxel 0.01", "--viewpoint 0,0,0"}) {
    EXPECT_FALSE(felt_as_image(more)) << more;
  }
}

}  // namespace
}  // namespace palpate::app
