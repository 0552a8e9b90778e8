// Samples of shapes and meshes: on the surface, without gaps, in trees of balls that hold them.
#include "palpate/tool/tool.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "base/numbers.hpp"
#include "palpate/base/error.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kSpacing = 2e-3;  // m

/// A random position on the surface of a box around the origin.
Vector3d on_box(Random& random, const Vector3d& size) {
  Vector3d at(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
  const auto axis = static_cast<Eigen::Index>(random.bits() % 3);
  at[axis] = std::copysign(0.5, at[axis]);
  return at.cwiseProduct(size);
}

double height_over_box(const Vector3d& x, const Vector3d& size) {
  return (x.cwiseAbs() - 0.5 * size).maxCoeff();
}

void expect_box(const Tool& tool, const Vector3d& size, const Vector3d& center, double gap) {
  for (const Tool::Point& each : tool.samples()) {
    EXPECT_NEAR(height_over_box(each.position - center, size), 0, 1e-12);
  }
  Random random(1);
  for (int i = 0; i < 500; ++i) EXPECT_LT(nearest(tool, center + on_box(random, size)), gap);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d at((corner & 1) - 0.5, (corner / 2 & 1) - 0.5, (corner / 4) - 0.5);
    EXPECT_LT(nearest(tool, center + at.cwiseProduct(size)), 1e-12);
  }
}

std::string error_of(const auto& make) {
  try {
    (void)make();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Tool, BoxIsSampledAllOver) {
  const Vector3d size(0.02, 0.03, 0.005);
  const Vector3d center(0.01, 0, -0.02);
  const Tool tool = Tool::box(size, kSpacing, center);
  expect_box(tool, size, center, kSpacing / std::numbers::sqrt2 + 1e-9);
  EXPECT_NEAR(tool.extent(), (size / 2 + Vector3d(0.01, 0, 0.02)).norm(), 1e-12);
  EXPECT_EQ(tool.roots().size(), 1u);
}

TEST(Tool, CylinderIsSampledAllOver) {
  const double radius = 0.01;
  const double length = 0.03;
  const Tool tool = Tool::cylinder(length, radius, kSpacing);
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const double angle = 2 * std::numbers::pi * random.uniform();
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    const double z = length * (random.uniform() - 0.5);
    EXPECT_LT(nearest(tool, radius * out + z * Vector3d::UnitZ()), kSpacing);
    const double rho = radius * std::sqrt(random.uniform());
    EXPECT_LT(nearest(tool, rho * out + length / 2 * Vector3d::UnitZ()), kSpacing);
  }
  for (const Tool::Point& each : tool.samples()) {
    const double side = each.position.head<2>().norm() - radius;
    const double end = std::abs(each.position.z()) - length / 2;
    EXPECT_NEAR(std::max(side, end), 0, 1e-12);
  }
}

TEST(Tool, CapsuleIsHardlyThinnerBetweenItsBalls) {
  const double radius = 4e-3;
  const Tool tool = Tool::capsule(0.05, radius, 1);
  for (double z = 0; z <= 0.05; z += 1e-4) {
    const double outside = nearest(tool, {radius, 0, -z});
    EXPECT_GE(outside, -1e-12);
    EXPECT_LT(outside, 0.01 * radius);
  }
  EXPECT_NEAR(tool.extent(), 0.054, 1e-12);
}

TEST(Tool, BallIsOneSample) {
  const Tool tool = Tool::ball(3e-3);
  ASSERT_EQ(tool.samples().size(), 1u);
  EXPECT_EQ(tool.samples()[0].radius, 3e-3);
  EXPECT_EQ(tool.gyration(), 0);
}

TEST(Tool, GripperMovesItsFingersApart) {
  const Tool tool = Tool::gripper({0.006, 0.012, 0.03}, kSpacing);
  ASSERT_EQ(tool.roots().size(), 2u);
  Pose pose;
  pose.position = {1, 2, 3};
  pose.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ());
  pose.opening = 0.02;
  double least = 1;  // distance of inner faces from the middle
  for (const Tool::Point& each : tool.samples()) {
    const Vector3d x = tool.in_world(each.position, each.side, pose) - pose.position;
    EXPECT_GT(each.side * x.y(), 0);  // the tool's x is the world's y
    least = std::min(least, std::abs(x.y()));
  }
  EXPECT_NEAR(least, 0.01, 1e-12);
  EXPECT_NEAR(nearest(tool, {0.006, 0.006, -0.03}), 0, 1e-12);
}

void expect_tree(const Tool& tool, std::int32_t index, std::set<std::uint32_t>& leaves) {
  const Tool::Node& node = tool.nodes()[static_cast<std::size_t>(index)];
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    const Tool::Point& sample = tool.samples()[i];
    EXPECT_LE((sample.position - node.center).norm() + sample.radius, node.radius + 1e-15);
    EXPECT_EQ(sample.side, node.side);
    const bool first = node.left >= 0 || leaves.insert(i).second;
    EXPECT_TRUE(first);
  }
  if (node.left < 0) return;
  EXPECT_GT(node.left, index);
  expect_tree(tool, node.left, leaves);
  expect_tree(tool, node.right, leaves);
}

TEST(Tool, TreesHoldEverySampleOnce) {
  for (const Tool& tool :
       {Tool::ball(1e-3), Tool::box({0.02, 0.03, 0.01}, kSpacing),
        Tool::gripper({0.006, 0.012, 0.03}, kSpacing), Tool::capsule(0.05, 0.004, kSpacing)}) {
    std::set<std::uint32_t> leaves;
    for (const std::int32_t root : tool.roots()) expect_tree(tool, root, leaves);
    EXPECT_EQ(leaves.size(), tool.samples().size());
  }
}

struct Triangles {
  std::vector<Vector3d> vertices;
  std::vector<Tool::Triangle> triangles;

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({a, b, c}); }
};

Triangles cube(double edge) {
  Triangles mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(edge * ((i & 1) - 0.5), edge * ((i / 2 & 1) - 0.5),
                               edge * (i / 4 - 0.5));
  }
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.add(a, b, c);
    mesh.add(a, c, d);
  }
  return mesh;
}

TEST(MeshTool, CubeIsSampledAllOver) {
  const Triangles mesh = cube(0.02);
  const Tool tool = Tool::mesh(mesh.vertices, mesh.triangles, kSpacing);
  expect_box(tool, Vector3d::Constant(0.02), Vector3d::Zero(), kSpacing);
  for (double x = -0.01; x <= 0.01; x += 1e-4) {
    EXPECT_LT(nearest(tool, {x, 0.01, 0.01}), kSpacing / 2 + 1e-9);
  }
  EXPECT_LT(tool.samples().size(), 1500u);
}

// Each triangle with corners of its own, as STL files have them.
TEST(MeshTool, SeparateTrianglesAreTheSameSurface) {
  const Triangles mesh = cube(0.02);
  Triangles soup;
  for (const Tool::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) soup.vertices.push_back(mesh.vertices[index]);
    const auto next = static_cast<std::uint32_t>(soup.vertices.size());
    soup.add(next - 3, next - 2, next - 1);
  }
  const Tool tool = Tool::mesh(soup.vertices, soup.triangles, kSpacing);
  expect_box(tool, Vector3d::Constant(0.02), Vector3d::Zero(), kSpacing);
  int in_corner = 0;
  for (const Tool::Point& each : tool.samples()) {
    in_corner += each.position == mesh.vertices[7] ? 1 : 0;
  }
  EXPECT_EQ(in_corner, 1);
}

// A cone with far more triangles than samples are wanted: its tip stays.
TEST(MeshTool, FineTriangulationsAreThinnedButKeepTheirTips) {
  Triangles mesh;
  constexpr std::uint32_t kAround = 400;  // triangles, 0.16 mm apart at the base
  const Vector3d tip(0, 0, -0.05);
  mesh.vertices.push_back(tip);
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    mesh.vertices.emplace_back(0.01 * std::cos(angle), 0.01 * std::sin(angle), 0);
  }
  for (std::uint32_t i = 0; i < kAround; ++i) mesh.add(0, 1 + i, 1 + (i + 1) % kAround);
  const Tool tool = Tool::mesh(mesh.vertices, mesh.triangles, kSpacing);
  EXPECT_LT(nearest(tool, tip), 1e-12);
  for (std::uint32_t i = 1; i <= kAround; ++i) {
    EXPECT_LT(nearest(tool, 0.5 * (tip + mesh.vertices[i])), kSpacing);
    EXPECT_LT(nearest(tool, mesh.vertices[i]), kSpacing / 2 + 1e-9);
  }
  EXPECT_LT(tool.samples().size(), 1500u);  // an area of 1600 mm2, at most one a square millimetre
}

TEST(MeshTool, RefusesWhatIsNoMesh) {
  Triangles mesh = cube(0.02);
  const auto make = [&] { return Tool::mesh(mesh.vertices, mesh.triangles, kSpacing); };
  mesh.add(0, 1, 8);
  EXPECT_THAT(error_of(make), HasSubstr("index is 8"));
  mesh.triangles = {{0, 1, 1}};
  EXPECT_THAT(error_of(make), HasSubstr("no triangle of the mesh has an area"));
  mesh = cube(0.02);
  mesh.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error_of(make), HasSubstr("not finite"));
  mesh = cube(21);  // millimetres in the place of metres
  EXPECT_THAT(error_of(make), HasSubstr("coordinate is 10.5"));
  mesh = cube(10);
  EXPECT_THAT(error_of(make), HasSubstr("give a larger one"));
}

TEST(Tool, RefusesSamplesThatAreNone) {
  EXPECT_THAT(error_of([] { return Tool({}); }), HasSubstr("no samples"));
  EXPECT_THAT(error_of([] { return Tool({{Vector3d::Zero(), -1, 0}}); }), HasSubstr("below 0"));
  EXPECT_THAT(error_of([] { return Tool({{Vector3d::Zero(), 0, 2}}); }), HasSubstr("side"));
  EXPECT_THAT(error_of([] { return Tool({{{0, 1e155, 0}, 0, 0}}); }), HasSubstr("10 at most"));
  EXPECT_THAT(error_of([] { return Tool::ball(11); }), HasSubstr("11 m out"));
  EXPECT_DOUBLE_EQ(Tool({{Vector3d::Zero(), 0, 0}}, {0, 1e-300, 0}).axis().y(), 1);
  EXPECT_THAT(error_of([] {
                return Tool({{Vector3d::Zero(), 0, 0}}, Vector3d::Zero());
              }),
              HasSubstr("no direction"));
  EXPECT_THAT(error_of([] { return Tool::box({1, 1, 1}, 1e-3); }), HasSubstr("larger"));
  EXPECT_THAT(error_of([] { return Tool::box({1, 0, 1}, 1e-3); }), HasSubstr("edge length is 0"));
  EXPECT_THAT(error_of([] { return Tool::ball(-1); }), HasSubstr("radius is -1"));
}

TEST(ToolText, NamesShapesAndTheirSizesInMillimetres) {
  EXPECT_NEAR(Tool::from_text("ball:3.5", kSpacing).extent(), 3.5e-3, 1e-15);
  EXPECT_NEAR(Tool::from_text("capsule:50x4", kSpacing).extent(), 0.054, 1e-15);
  EXPECT_NEAR(Tool::from_text("capsule:.5e2x+4", kSpacing).extent(), 0.054, 1e-15);
  EXPECT_NEAR(Tool::from_text("cylinder:60x40", kSpacing).extent(), 0.05, 1e-15);
  expect_box(Tool::from_text("box:20x30x5", kSpacing), {0.02, 0.03, 0.005}, Vector3d::Zero(),
             kSpacing);
  EXPECT_EQ(Tool::from_text("gripper:6x12x30", kSpacing).roots().size(), 2u);
}

TEST(ToolText, SaysWhatIsWrongAndHowToWriteIt) {
  const auto error = [](const char* text) {
    return error_of([&] { return Tool::from_text(text, kSpacing); });
  };
  EXPECT_THAT(error("bowl:3"),
              HasSubstr("\"bowl:3\" is no shape; give one of ball:R, capsule:LxR"));
  EXPECT_THAT(error(""), HasSubstr("is no shape"));
  for (const char* text : {"box:20x30", "box:20x30x5x1", "box:20x30x", "box:20xx5", "box:20x30x5mm",
                           "box", "box:", "box:20x-30x5", "box:0x3x4", "box:.x3x4", "box:nanx3x4",
                           "box:infx3x4", "box:1.2.3x3x4", "box:20000x3x4"}) {
    EXPECT_THAT(error(text), HasSubstr("give box:XxYxZ in millimetres")) << text;
  }
  EXPECT_THAT(error("ball:0"), HasSubstr("give ball:R in millimetres, a number above 0"));
}

}  // namespace
}  // namespace palpate::test
