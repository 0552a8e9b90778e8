// The program with a mesh as a tool: its unit, its faces and its samples.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "apps/palpate/cli/output.hpp"
#include "apps/program.hpp"
#include "support/mesh_files.hpp"

namespace palpate::app {
namespace {

using testing::HasSubstr;
using testing::Not;

// An STL file in millimetres of a box of 20 x 30 x 10, around its handle.
std::string box_stl() {
  return test::as_stl(test::box_mesh(Eigen::Vector3d(10, 15, 5)));
}

TEST(ToolMeshProgram, AMeshIsHeldAsTheShapeThatItIs) {
  Shell shell;
  shell.write("part.stl", box_stl());
  const std::string rest = " --duration 1 --json report.json --log ";
  const Outcome mesh = shell.run("touch synthetic:torus --tool mesh:part.stl" + rest + "a.csv");
  ASSERT_EQ(mesh.code, 0) << mesh.err;
  EXPECT_THAT(mesh.out, HasSubstr("taken as millimetres"));
  const Json report = Json::parse(shell.read("report.json"));
  EXPECT_NEAR(report["tool"]["extent_m"].get<double>(), Eigen::Vector3d(10, 15, 5).norm() * 1e-3,
              1e-9);
  EXPECT_GT(report["largest_force_N"].get<double>(), 0.1);
  EXPECT_EQ(shell.run("touch synthetic:torus --tool mesh:part.stl,unit=0.01" + rest + "b.csv").code,
            0);
  EXPECT_NEAR(Json::parse(shell.read("report.json"))["tool"]["extent_m"].get<double>(),
              Eigen::Vector3d(10, 15, 5).norm() * 1e-2, 1e-9);
}

// A box with a face twice, and a face without an area.
TEST(ToolMeshProgram, SaysWhichFacesOfAMeshAreLeftOut) {
  Shell shell;
  test::TestMesh box = test::box_mesh(Eigen::Vector3d(10, 15, 5));
  box.faces.push_back(box.faces.front());
  box.faces.push_back({0, 1, 1});
  shell.write("part.stl", test::as_stl(box));
  for (const char* command : {"info", "touch synthetic:torus --duration 0.1"}) {
    const Outcome outcome =
        shell.run(fmt::format("{} --tool mesh:part.stl --json a.json", command));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("1 faces of the mesh left out, which have no area"));
    EXPECT_THAT(outcome.out, HasSubstr("1 faces of the mesh left out, which are there twice"));
    const Json report = Json::parse(shell.read("a.json"));
    const Json tool = report.is_array() ? report[0]["tool"] : report["tool"];
    EXPECT_EQ(tool["faces_dropped"], 1) << command;
    EXPECT_EQ(tool["faces_duplicate"], 1) << command;
  }
  shell.write("part.stl", box_stl());
  EXPECT_THAT(shell.run("info --tool mesh:part.stl").out, Not(HasSubstr("left out")));
}

TEST(ToolMeshProgram, AdviceOfAMeshInMillimetresWorksWhenItIsFollowed) {
  Shell shell;
  shell.write("large.ply", test::as_ply(test::box_mesh(Eigen::Vector3d(30, 20, 10))));
  const Outcome refused = shell.run("info --tool mesh:large.ply");
  EXPECT_EQ(refused.code, 1);
  const std::string advice = "mesh:large.ply,unit=0.001";
  ASSERT_THAT(refused.err, HasSubstr("give " + advice));
  EXPECT_EQ(shell.run("info --tool " + advice).code, 0);
}

// What is too large even in millimetres, or far from its origin, is no matter of millimetres.
TEST(ToolMeshProgram, AMeshThatReachesTooFarIsToldWhy) {
  Shell shell;
  test::TestMesh far = test::box_mesh(Eigen::Vector3d(10, 15, 5));
  for (Eigen::Vector3d& vertex : far.vertices) vertex.x() += 30'000;
  shell.write("far.stl", test::as_stl(far));
  shell.write("huge.stl", test::as_stl(test::box_mesh(Eigen::Vector3d(3e4, 4e4, 2e4))));
  const auto refusal = [&shell](const std::string& tool) {
    const Outcome outcome = shell.run("info --tool mesh:" + tool);
    EXPECT_EQ(outcome.code, 1) << tool;
    return outcome.err;
  };
  const std::string huge = refusal("huge.stl");
  EXPECT_THAT(huge,
              HasSubstr("huge.stl is 60.0 km x 80.0 km x 40.0 km if a unit of the file is 1"));
  EXPECT_THAT(huge, HasSubstr("give mesh:huge.stl,unit=METRES"));
  EXPECT_THAT(refusal("huge.stl,unit=0.001"), HasSubstr("if a unit of the file is 1.00 mm"));
  EXPECT_THAT(refusal("huge.stl,unit=0.001"), Not(HasSubstr("unit=0.001 if")));
  EXPECT_THAT(refusal("far.stl"), HasSubstr("reaches 30.0 m from its origin"));
  EXPECT_THAT(refusal("far.stl"), HasSubstr("or move it to its origin"));
  EXPECT_EQ(shell.run("info --tool mesh:huge.stl,unit=0.0001").code, 0);
}

// A rugged sheet: all of its vertices are corners.
TEST(ToolMeshProgram, AMeshOfCreasesAloneIsSaidToBeOne) {
  std::string obj;
  constexpr int kSide = 30;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int height = 31 * i * i % 7;
    obj += fmt::format("v {} {} {}\n", 2 * (i / kSide), 2 * (i % kSide), height);
  }
  for (int i = 0; i + 1 < kSide; ++i) {
    for (int k = 1; k < kSide; ++k) {
      const int a = kSide * i + k;
      obj += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + 1, a + kSide, a + 1, a + kSide + 1,
                         a + kSide);
    }
  }
  Shell shell;
  shell.write("rugged.obj", obj);
  const Outcome outcome = shell.run("info --tool mesh:rugged.obj");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("most are at corners and creases of the mesh"));
}
}  // namespace
}  // namespace palpate::app
