// Splats as a user of the program meets them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "support/splat_files.hpp"
#include "support/splat_scenes.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;

std::vector<Splat> ball() {
  return test::make_splats(
      test::splat_sphere(0.5),
      {.count = 4000, .thickness = 3e-3, .width = 15e-3, .length = 70e-3, .floaters = 0}, 8);
}

TEST(SplatsProgram, InfoSaysWhatBecameOfThemAndThatTheyHaveNoUnit) {
  Shell shell;
  shell.write("ball.ply", test::splat_ply(ball()));
  const Outcome outcome = shell.run("info ball.ply --json i.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("splats     4 000 read, "));
  EXPECT_THAT(outcome.out, HasSubstr("of opacity 0.02 and more; shell "));
  EXPECT_THAT(outcome.out, HasSubstr("splats have no unit"));
  EXPECT_THAT(outcome.out, HasSubstr("give --length"));
  const auto info = nlohmann::json::parse(shell.read("i.json"))[0];
  EXPECT_EQ(info["splats"]["read"], 4000);
  EXPECT_EQ(info["splats"]["points"], info["points"]);
  const Outcome told = shell.run("info ball.ply --length 2");
  EXPECT_THAT(told.out, HasSubstr("2.0"));
  EXPECT_THAT(told.out, testing::Not(HasSubstr("give --length")));
}

TEST(SplatsProgram, InfoSaysHowManyAreLeftOut) {
  Shell shell;
  std::vector<Splat> splats = ball();
  for (std::size_t i = 0; i < 12; ++i) splats[i].sigma.setConstant(1000);
  for (std::size_t i = 12; i < 15; ++i) splats[i].position.setConstant(1e9F);
  for (std::size_t i = 0; i < 15; ++i) splats[i].opacity = 0.5F;
  shell.write("room.ply", test::splat_ply(splats));
  const Outcome outcome = shell.run("info room.ply --json i.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("left out: 3 too far away; left out: 12 too large"));
  const auto info = nlohmann::json::parse(shell.read("i.json"))[0];
  EXPECT_EQ(info["splats"]["far"], 3);
  EXPECT_EQ(info["splats"]["huge"], 12);
}

TEST(SplatsProgram, WrittenPointsAreFeltAsTheSplatsAreBitForBit) {
  Shell shell;
  shell.write("ball.spz", test::spz(ball(), 4));
  ASSERT_EQ(shell.run("info ball.spz --length 0.2 --write points.ply").code, 0);
  const std::string touch = " --duration 2 --device scripted --log ";
  ASSERT_EQ(shell.run("touch ball.spz --length 0.2" + touch + "splats.csv").code, 0);
  ASSERT_EQ(shell.run("touch points.ply" + touch + "points.csv").code, 0);
  const auto splats = columns(shell.read("splats.csv"));
  const auto points = columns(shell.read("points.csv"));
  double largest = 0;
  for (const char* name : {"fx", "fy", "fz"}) {
    ASSERT_EQ(splats.at(name), points.at(name));
    for (const std::string& cell : splats.at(name)) {
      largest = std::max(largest, std::abs(number(cell)));
    }
  }
  EXPECT_GT(largest, 0.5);
}

TEST(SplatsProgram, LengthIsOfAnyCloud) {
  Shell shell;
  std::string text;
  for (int i = 0; i < 900; ++i) text += fmt::format("{} {} 10\n", 100 * (i % 30), 50 * (i / 30));
  shell.write("plane.xyz", text);
  ASSERT_EQ(shell.run("info plane.xyz --length 0.29 --json i.json").code, 0);
  const auto info = nlohmann::json::parse(shell.read("i.json"))[0];
  const double lower = info["bounds_m"]["lower"][0];
  const double upper = info["bounds_m"]["upper"][0];
  EXPECT_NEAR(upper - lower, 0.29, 1e-6);
}

TEST(SplatsProgram, RefusesWhatDoesNotSuitThem) {
  Shell shell;
  shell.write("ball.splat", test::dot_splat(ball()));
  const auto refusal = [&](const std::string& options) {
    const Outcome outcome = shell.run("touch ball.splat --duration 1 " + options);
    EXPECT_NE(outcome.code, 0);
    return outcome.err;
  };
  EXPECT_THAT(refusal("--voxel 0.01"), HasSubstr("--voxel is not for splats"));
  EXPECT_THAT(refusal("--unorganised"), HasSubstr("applies only to depth images"));
  EXPECT_THAT(refusal("--length 2 --scale 3"), HasSubstr("remove --scale or --length"));
  EXPECT_THAT(refusal("--length 0"), HasSubstr("--length"));
}

}  // namespace
}  // namespace palpate::app
