// The first step of the loop that a user writes: a hand that begins and rests close in front of a
// surface is in front of it.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "palpate/tool/tool_field.hpp"
#include "palpate/tool/tool_proxy.hpp"
#include "support/effort.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr std::array kInFront = {0.1, 0.2, 0.3, 0.4, 0.5};  // R
constexpr int kResting = 100;                               // ticks, longer than any force fades
constexpr int kHands = 60;                                  // at each height

/// A place in front of a surface, and the way out there.
struct Start {
  Vector3d hand;
  Vector3d outward;
};

/// What a hand feels in the end that rests where it begins.
Vector3d felt_by_point(Scene& scene, const Vector3d& hand) {
  SceneField field(scene);
  Proxy proxy;
  Contact contact;
  for (int tick = 0; tick < kResting; ++tick) {
    field.update(kTick * tick, hand, proxy);
    contact = proxy.step(field, hand, kTick);
  }
  return contact.force;
}

Vector3d felt_by_tool(Scene& scene, const Vector3d& hand) {
  const auto tool = std::make_shared<const Tool>(std::vector<Tool::Point>(1));
  ToolField field(scene, tool);
  ToolProxy proxy(tool);
  Pose pose;
  pose.position = hand;
  ToolContact contact;
  for (int tick = 0; tick < kResting; ++tick) {
    field.update(kTick * tick, pose, proxy);
    contact = proxy.step(field, pose, kTick);
  }
  return contact.wrench.force;
}

/// Places above points of the cloud, where nothing else of it is nearer.
std::vector<Start> starts_above(const SurfacePoints& points, double in_front) {
  std::vector<Start> starts;
  std::vector<CellGrid::Neighbor> near;
  const auto count = static_cast<std::size_t>(effort(kHands));
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = k * points.size() / count;
    const double height = in_front * static_cast<double>(points.radii[i]);
    const Eigen::Vector3f hand =
        points.grid.points()[i] + static_cast<float>(height) * points.normals[i];
    points.grid.nearest(hand, 1, near);
    if (near.front().index != i) continue;
    starts.push_back({points.origin + hand.cast<double>(), points.normals[i].cast<double>()});
  }
  return starts;
}

void expect_free(Scene& scene, const std::vector<Start>& starts, double in_front) {
  ASSERT_FALSE(starts.empty());
  int points_inside = 0;
  int tools_inside = 0;
  for (const Start& start : starts) {
    if (felt_by_point(scene, start.hand).dot(start.outward) < 0) ++points_inside;
    if (felt_by_tool(scene, start.hand).dot(start.outward) < 0) ++tools_inside;
  }
  EXPECT_EQ(points_inside, 0) << "of " << starts.size() << " at " << in_front << " R";
  EXPECT_EQ(tools_inside, 0) << "of " << starts.size() << " at " << in_front << " R";
}

void expect_free_above(const PointCloud& cloud) {
  Scene scene;
  const auto points = scene.add("cloud", cloud).points();
  for (const double in_front : kInFront) {
    expect_free(scene, starts_above(*points, in_front), in_front);
  }
}

TEST(FirstStep, InFrontOfASphereIsInFront) {
  expect_free_above(synthetic_cloud("sphere"));
}

TEST(FirstStep, InFrontOfATorusIsInFront) {
  expect_free_above(synthetic_cloud("torus"));
}

/// Its ears bend within R, and its legs meet the body in creases.
TEST(FirstStep, InFrontOfARabbitIsInFront) {
  expect_free_above(synthetic_cloud("rabbit"));
}

TEST(FirstStep, InFrontOfTheBunnyIsInFront) {
  const char* const data = std::getenv("PALPATE_DATA");
  const std::filesystem::path path =
      std::filesystem::path(data ? data : "") / "stanford_bunny/bun_zipper.ply";
  if (!data || !std::filesystem::exists(path)) GTEST_SKIP() << "no PALPATE_DATA";
  expect_free_above(read_cloud(path));
}

/// The world's origin is at its foot, where all three faces can be seen from.
TEST(FirstStep, OnAStepIsInFront) {
  constexpr double kSpacing = 2e-3;  // m
  constexpr double kRadius = 8e-3;   // m
  constexpr double kHeight = 1.2 * kRadius;
  PointCloud cloud;
  const auto add = [&](double x, double y, double z) {
    cloud.positions.push_back((Vector3d(x, y, z)).cast<float>());
  };
  for (int j = -20; j <= 20; ++j) {
    const double y = kSpacing * j;
    for (int i = 1; i <= 20; ++i) add(kSpacing * i, y, 0);
    for (int i = 0; i <= 20; ++i) add(-kSpacing * i, y, kHeight);
    for (double z = 0; z < kHeight - 0.5 * kSpacing; z += kSpacing) add(0, y, z);
  }
  Scene scene;
  scene.add("step", cloud, {.prepare = {.radius = kRadius}});
  for (const double in_front : kInFront) {
    std::vector<Start> starts;
    const int count = effort(kHands);
    for (int k = 0; k < count; ++k) {
      const double away = (1.0 + 3.0 * k / count) * kRadius;  // from the wall
      const double y = (k % 7 - 3) * 1e-3;
      const double up = in_front * kRadius;
      starts.push_back({{away, y, up}, Vector3d::UnitZ()});
      starts.push_back({{-away, y, kHeight + up}, Vector3d::UnitZ()});
    }
    expect_free(scene, starts, in_front);
  }
}

}  // namespace
}  // namespace palpate::test
