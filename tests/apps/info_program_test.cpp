#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/program.hpp"
#include "support/effort.hpp"

namespace palpate::app {
namespace {

TEST(Info, TellsPointsBoundsUnitsSpacingHolesAndAdvice) {
  Shell shell;
  shell.write("plane.xyz", plane_xyz());
  const Outcome outcome = shell.run("info plane.xyz --json info.json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word : {"points", "961", "units", "metres", "spacing", "noise", "holes",
                           "--voxel", "--radius", "density"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
  const auto info = nlohmann::json::parse(shell.read("info.json"))[0];
  EXPECT_EQ(info["points"], 961);
  EXPECT_NEAR(info["spacing_m"]["nearest_three"].get<double>(), 2e-3, 1e-5);
  EXPECT_NEAR(info["spacing_m"]["from_area"].get<double>(), 2e-3, 1e-5);
  EXPECT_NEAR(info["bounds_m"]["upper"][0].get<double>(), 0.03, 1e-6);
}

/// A sheet whose normals point up, `at` away from the origin, as a PLY file.
std::string sheet_with_normals(const Eigen::Vector3d& at) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 961\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    text += fmt::format("property float {}\n", name);
  }
  text += "end_header\n";
  for (int i = 0; i < 961; ++i) {
    const Eigen::Vector3d p = at + 2e-3 * Eigen::Vector3d(i % 31 - 15, i / 31 - 15, 0);
    text += fmt::format("{} {} {} 0 0 1\n", p.x(), p.y(), p.z());
  }
  return text;
}

TEST(Info, AdviceOnTheViewpointThatNormalsFaceWorks) {
  Shell shell;
  shell.write("beside.ply", sheet_with_normals({3, 4, 0.5}));
  const std::string beside = shell.run("info beside.ply").out;
  const std::size_t advice = beside.find("--viewpoint ");
  ASSERT_NE(advice, std::string::npos) << beside;
  const std::string option = beside.substr(advice, beside.find(' ', advice + 12) - advice);
  shell.write("hand.csv", "t,hip_x,hip_y,hip_z\n0,3,4,0.48\n0.2,3,4,0.48\n0.4,3,4,0.503\n");
  const auto contacts = [&](const std::string& options) {
    const Outcome run =
        shell.run("touch beside.ply --trajectory hand.csv --json run.json " + options);
    EXPECT_EQ(run.code, 0) << run.err;
    return nlohmann::json::parse(shell.read("run.json"))["contacts"].get<int>();
  };
  EXPECT_EQ(contacts(""), 1);
  EXPECT_EQ(contacts(option), 0) << option;
}

TEST(Info, ReadsStandardInput) {
  Shell shell;
  const Outcome outcome = shell.run("info -", plane_xyz());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("961"), std::string::npos);
}

TEST(Info, SuspectsMillimetres) {
  Shell shell;
  std::string text;
  for (int i = 0; i < 900; ++i) text += fmt::format("{} {} 10\n", 100 * (i % 30), 100 * (i / 30));
  shell.write("mm.xyz", text);
  const Outcome outcome = shell.run("info mm.xyz");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("--scale 0.001"), std::string::npos);
}

TEST(Info, TakesAMeshWithoutAUnitForMillimetresUnlessToldOtherwise) {
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  Shell shell;
  shell.write("part.obj",
              "v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const std::string guessed = shell.run("info part.obj").out;
  EXPECT_NE(guessed.find("taken as millimetres"), std::string::npos) << guessed;
  EXPECT_NE(guessed.find("20.0 mm long"), std::string::npos) << guessed;
  EXPECT_NE(guessed.find("--scale: 1 for metres"), std::string::npos) << guessed;
  const std::string spaced = shell.run("info part.obj --mesh-spacing 0.001").out;
  EXPECT_NE(spaced.find("1.00 mm apart"), std::string::npos) << spaced;
  const std::string told = shell.run("info part.obj --scale 1").out;
  EXPECT_EQ(told.find("millimetres"), std::string::npos) << told;
  EXPECT_NE(told.find("20.0 m long"), std::string::npos) << told;
}

TEST(Info, TellsTheCameraOfAnOrganisedCloud) {
  Shell shell;
  for (const bool bent : {false, true}) {
    std::string cloud =
        "FIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH 64\nHEIGHT 48\nPOINTS 3072\n"
        "DATA ascii\n";
    for (int i = 0; i < 64 * 48; ++i) {
      const double z = 0.5 + 0.001 * (i % 7);
      const double x = (i % 64 - 31.5) / 60;
      cloud += fmt::format("{} {} {}\n", (bent ? x * x * x : x) * z, (i / 64 - 23.5) * z / 60, z);
    }
    shell.write("wall.pcd", cloud);
    const Outcome outcome = shell.run("info wall.pcd --json info.json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(
        outcome.out.find(bent ? "64 x 48, processed as unorganised points: no pinhole camera"
                              : "64 x 48 pixels, focal length 60 px, processed as a depth frame"),
        std::string::npos)
        << outcome.out;
    const auto organised = nlohmann::json::parse(shell.read("info.json"))[0]["organised"];
    ASSERT_EQ(organised.is_null(), bent);
    if (bent) continue;
    EXPECT_NEAR(organised["pinhole_px"]["cx"].get<double>(), 31.5, 1e-6);
  }
}

TEST(Info, OnePointIsACloud) {
  Shell shell;
  const Outcome outcome = shell.run("info -", "1 2 3\n");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST(Info, WhatHasNoSurfaceSaysSoAndSoDoesTouch) {
  Shell shell;
  shell.write("line.xyz", "0 0 0\n0.01 0 0\n0.02 0 0\n");
  const std::string none = "at one place or on a line, where no surface is";
  EXPECT_NE(shell.run("info line.xyz").out.find(none), std::string::npos);
  const Outcome touched = shell.run("touch line.xyz --duration 0.1");
  EXPECT_NE(touched.out.find(none), std::string::npos) << touched.out;
  EXPECT_EQ(touched.out.find("more time"), std::string::npos);
}

TEST(Info, PictureOfEachCloudIsDrawnOrSaysWhatIsMissing) {
  Shell shell;
  const Outcome outcome =
      shell.run("info synthetic:torus - --picture a.png --json a.json", "1 2 3\n");
  if (outcome.code == 0) {
    EXPECT_EQ(shell.read("a.png").substr(1, 3), "PNG");
    EXPECT_EQ(shell.read("a-2.png").substr(1, 3), "PNG");
    EXPECT_EQ(nlohmann::json::parse(shell.read("a.json")).size(), 2u);
  } else {
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("python3-matplotlib"), std::string::npos) << outcome.err;
  }
}

TEST(Info, PictureThatCannotBeDrawnIsToldBeforeTheWork) {
  Shell shell;
  const Outcome outcome =
      shell.run("info synthetic:torus --picture a.png --json a.json", "", "PYTHONHOME=/nowhere");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("python3-matplotlib"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(std::filesystem::exists(shell.path("a.json")));
}

}  // namespace
}  // namespace palpate::app
