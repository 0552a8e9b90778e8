// The program uses the unit that a file states, says what it took, and prints remedies that work.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "apps/program.hpp"
#include "support/effort.hpp"
#include "support/mesh_files.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;
using testing::Not;

// A sheet of 30 x 30 points, 58 long and 29 high.
std::string sheet(const std::string& header) {
  std::string text = header + "\n";
  for (int i = 0; i < 900; ++i)
    text += fmt::format("{},{},{}\n", 2 * (i % 30), 2 * (i / 30), i % 30);
  return text;
}

// Lengths along x and z that info reports, m.
std::pair<double, double> lengths(Shell& shell, const std::string& arguments) {
  const Outcome outcome = shell.run("info " + arguments + " --json info.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto bounds = nlohmann::json::parse(shell.read("info.json"))[0]["bounds_m"];
  const auto length = [&](int axis) {
    return bounds["upper"][axis].get<double>() - bounds["lower"][axis].get<double>();
  };
  return {length(0), length(2)};
}

TEST(UnitsProgram, TheRemedyForHeightsWithoutAUnitWorks) {
  Shell shell;
  shell.write("feet.csv", sheet("Easting (ft),Northing (ft),Up"));
  EXPECT_THAT(shell.run("info feet.csv").out, HasSubstr("give --scale 0.3048,1"));
  const auto [x, z] = lengths(shell, "feet.csv");
  EXPECT_NEAR(x, 58 * 0.3048, 1e-4);
  EXPECT_NEAR(z, 29 * 0.3048, 1e-4);
  const auto [plan, height] = lengths(shell, "feet.csv --scale 0.3048,1");
  EXPECT_NEAR(plan, 58 * 0.3048, 1e-4);
  EXPECT_NEAR(height, 29, 1e-4);
  shell.write("run.toml", "[[source]]\nfrom = \"feet.csv\"\nscale = [0.3048, 1]\n");
  EXPECT_EQ(shell.run("touch --setup run.toml --duration 0.1").code, 0);
  EXPECT_THAT(shell.run("info feet.csv --scale 1,2,3").err, HasSubstr("more than 2 numbers"));
  EXPECT_THAT(shell.run("info feet.csv --scale 1,-2").err, HasSubstr("not a number above 0"));
  EXPECT_THAT(shell.run("info feet.csv --scale 1").out,
              HasSubstr("the file says that it is in feet"));
}

TEST(UnitsProgram, AStoreHasTheUnitThatItsFilesState) {
  Shell shell;
  shell.write("mm.csv", sheet("X [mm],Y [mm],Z [mm]"));
  const Outcome tiled = shell.run("tile mm.csv --out store --json tile.json");
  ASSERT_EQ(tiled.code, 0) << tiled.err;
  EXPECT_THAT(tiled.out, HasSubstr("millimetres, the file says so"));
  EXPECT_EQ(nlohmann::json::parse(shell.read("tile.json"))["inputs"][0]["units"], "millimetres");
  EXPECT_NEAR(lengths(shell, "store").first, 0.058, 1e-6);
  EXPECT_THAT(shell.run("info store").out, HasSubstr("metres: the file says so by its projection"));
}

TEST(UnitsProgram, MeshesOfOneSceneHaveOneUnit) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  shell.write("small.stl", test::as_stl(test::box_mesh({0.15, 0.05, 0.05})));
  shell.write("large.stl", test::as_stl(test::box_mesh({0.6, 0.05, 0.05})));
  const Outcome both = shell.run("touch small=small.stl large=large.stl --duration 0.05");
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("small is by its size in metres"));
  EXPECT_THAT(both.out, Not(HasSubstr("taken as millimetres")));
  const Outcome alone = shell.run("touch large.stl --duration 0.05");
  EXPECT_THAT(alone.out, HasSubstr("taken as millimetres"));
  EXPECT_THAT(alone.out, HasSubstr("give --scale: 1 for metres"));
}

TEST(UnitsProgram, ALongPartPullsNoOthersToMetres) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  const auto plate = [](double size) {
    return fmt::format("v 0 0 0\nv {0} 0 0\nv {0} {0} 0\nv 0 {0} 0\nf 1 2 3 4\n", size);
  };
  shell.write("small.obj", plate(150));
  shell.write("large.obj", plate(2100));
  const std::string run = "touch small=small.obj large=large.obj --duration 0.02";
  const Outcome both = shell.run(run);
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_THAT(both.out, Not(HasSubstr("taken as metres")));
  EXPECT_THAT(both.out, HasSubstr("small is by its size in millimetres"));
  EXPECT_THAT(both.out, HasSubstr("give --scale: 1 for metres"));
  shell.write("small.obj", "# Unit: inch\n" + plate(15));
  const Outcome stated = shell.run(run);
  ASSERT_EQ(stated.code, 0) << stated.err;
  EXPECT_THAT(stated.out, HasSubstr("it states no unit, and small states inches"));
}

}  // namespace
}  // namespace palpate::app
