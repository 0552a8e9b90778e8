#include <gtest/gtest.h>

#include <cmath>

#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::TestPoint;

constexpr double kRadius = 0.010;
constexpr double kSpacing = 0.004;

// A square of 120 mm at height z, cut off beyond `end`.
std::vector<TestPoint> sheet(double z, double end = 1, double up = 1, double radius = kRadius) {
  std::vector<TestPoint> points;
  for (int i = -15; i <= 15; ++i) {
    for (int j = -15; j <= 15; ++j) {
      const Vector3d p(kSpacing * i, kSpacing * j, z);
      if (p.x() <= end) points.push_back({p, Vector3d(0, 0, up), radius, 1});
    }
  }
  return points;
}

void add(Scene& scene, const std::string& name, const std::vector<TestPoint>& points) {
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back({std::make_shared<SurfacePoints>(test::make_points(points))});
  scene.add(name).publish(std::move(snapshot));
}

// Heights on the line through (x, 0) where the field changes its sign.
std::vector<double> crossings(SceneField& field, double x) {
  constexpr double kStep = 1e-4;
  std::vector<double> found;
  double last = 0;
  for (double z = -0.03; z <= 0.03; z += kStep) {
    const double value = field.sample({x, 0, z}).value;
    if (last * value < 0) found.push_back(z);
    last = value;
  }
  return found;
}

std::vector<double> crossings_of(const std::vector<std::vector<TestPoint>>& sources, double x) {
  Scene scene;
  for (const auto& source : sources) add(scene, std::to_string(scene.size()), source);
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), {x, 0, 0.025});
  return crossings(field, x);
}

// From 0.7 R on, sums over all points would make two sheets of them.
TEST(UnitedHeight, SurfacesThatLieApartAreOne) {
  for (const double apart : {0.2, 0.5, 0.7, 0.9}) {
    const double half = 0.5 * apart * kRadius;
    const auto found = crossings_of({sheet(-half), sheet(half)}, 0);
    // Solid from where points weigh enough, below, up to the surface.
    ASSERT_EQ(found.size(), 2U) << apart;
    EXPECT_NEAR(found[1], 0, 2e-4) << apart;
  }
}

TEST(UnitedHeight, FollowsTheSourceThatSeesFinely) {
  const auto found = crossings_of({sheet(-1.5e-3), sheet(1.5e-3, 1, 1, 2 * kRadius)}, 0);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found.back(), -1.5e-3, 2.5e-4);
}

// Where the upper one ends, the surface comes down in a slope, and nowhere in two sheets.
TEST(UnitedHeight, EndOfOneSourceIsASlope) {
  const double apart = 0.7 * kRadius;
  double last = apart / 2;
  for (double x = -0.02; x <= 0.02; x += 1e-3) {
    const auto found = crossings_of({sheet(0), sheet(apart, 0)}, x);
    ASSERT_EQ(found.size(), 2U) << x;
    EXPECT_LT(std::abs(found[1] - last), 1.5e-3) << x;
    last = found[1];
  }
  EXPECT_NEAR(last, 0, 2e-4);
}

TEST(UnitedHeight, TwoSidesOfAPlateStayWhereTheyAre) {
  constexpr double kThick = 3e-3;
  const auto both = crossings_of({sheet(0), sheet(-kThick, 1, -1)}, 0);
  auto plate = sheet(0);
  const auto back = sheet(-kThick, 1, -1);
  plate.insert(plate.end(), back.begin(), back.end());
  const auto one = crossings_of({plate}, 0);
  ASSERT_FALSE(both.empty());
  ASSERT_EQ(both.size(), one.size());
  EXPECT_NEAR(both.back(), one.back(), 1.5e-4);
}

TEST(UnitedHeight, StaysFiniteWhereASourceHasNoNormal) {
  auto torn = sheet(0);
  for (std::size_t i = 0; i < torn.size(); ++i) torn[i].normal.z() = i % 2 == 0 ? 1 : -1;
  Scene scene;
  add(scene, "whole", sheet(1e-3));
  add(scene, "torn", torn);
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  for (double z = -0.01; z <= 0.01; z += 2.5e-4) {
    for (const double x : {0.0, 0.5 * kSpacing, kSpacing}) {
      const Sample sample = field.sample({x, 0, z});
      EXPECT_TRUE(std::isfinite(sample.value) && sample.gradient.allFinite()) << x << " " << z;
    }
  }
}

}  // namespace
}  // namespace palpate
