#include "field/patch.hpp"

#include <gtest/gtest.h>

#include <random>

#include "field/evaluate.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::make_points;
using test::TestPoint;
using test::wavy_sheet;

std::vector<ActiveLayer> one_layer(const SurfacePoints& points) {
  return {{&points}};
}

bool free_space(const ImplicitSurface& surface, const std::vector<ActiveLayer>& layers,
                const Ball& ball) {
  int visits = 8192;
  return is_free_space(surface, layers, 1, ball, 0, visits);
}

TEST(Patch, HoldsEveryPointWhoseSupportReachesTheBall) {
  const auto given = wavy_sheet(1);
  const SurfacePoints points = make_points(given);
  const Vector3d center(3e-3, -5e-3, 4e-3);
  constexpr double kExtra = 5e-3;
  std::size_t expected = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points.grid.points()[i].cast<double>() - center).norm();
    if (distance <= points.radii[i] + kExtra) ++expected;
  }
  Patch patch(2048);
  patch.gather(one_layer(points), 1, center, kExtra);
  EXPECT_EQ(patch.points(), expected);
  EXPECT_FALSE(patch.thinned());
  EXPECT_TRUE(patch.covers({center + Vector3d(4e-3, 0, 0), 0.9e-3}));
  EXPECT_FALSE(patch.covers({center + Vector3d(4e-3, 0, 0), 1.1e-3}));
}

TEST(Patch, SamplesDoNotDependOnWhereItWasGathered) {
  const SurfacePoints points = make_points(wavy_sheet(2));
  const ImplicitSurface surface{FieldOptions{}};
  Patch here(2048);
  Patch there(2048);
  const Vector3d x(1e-3, 2e-3, 1e-3);
  here.gather(one_layer(points), 1, x, 1e-3);
  there.gather(one_layer(points), 1, x + Vector3d(6e-3, -4e-3, 2e-3), 12e-3);
  const Sample a = evaluate(surface, here, x);
  const Sample b = evaluate(surface, there, x);
  EXPECT_NEAR(a.value, b.value, 1e-15);
  EXPECT_LT((a.gradient - b.gradient).norm(), 1e-12);
}

TEST(Patch, ThinsDeterministicallyAndKeepsTheWeight) {
  std::vector<TestPoint> plane;
  for (int i = -40; i <= 40; ++i) {
    for (int j = -40; j <= 40; ++j) {
      plane.push_back({{0.5e-3 * i, 0.5e-3 * j, 0}, Vector3d::UnitZ(), 8e-3, 1});
    }
  }
  SurfacePoints points = make_points(plane);
  const ImplicitSurface surface{FieldOptions{}};
  Patch full(8192);
  Patch small(512);
  full.gather(one_layer(points), 1, Vector3d::Zero(), 4e-3);
  small.gather(one_layer(points), 1, Vector3d::Zero(), 4e-3);
  ASSERT_GT(full.points(), 512u);
  EXPECT_TRUE(small.thinned());
  EXPECT_LE(small.points(), 512u);
  const Vector3d x(1e-3, 0, 1e-3);
  EXPECT_NEAR(evaluate(surface, small, x).support, evaluate(surface, full, x).support, 0.05);
  EXPECT_NEAR(evaluate(surface, small, x).value, 1e-3, 1e-9);
}

TEST(Patch, AnEmptyOneIsFree) {
  const SurfacePoints points = make_points(wavy_sheet(3));
  const ImplicitSurface surface{FieldOptions{}};
  Patch patch(64);
  patch.gather(one_layer(points), 1, Vector3d(1, 1, 1), 1e-2);
  EXPECT_EQ(patch.points(), 0u);
  EXPECT_TRUE(is_free(surface, patch, {Vector3d(1, 1, 1), 1e-2}));
  EXPECT_EQ(evaluate(surface, patch, Vector3d(1, 1, 1)).support, 0);
}

TEST(Patch, MovingPointsAreWhereTheyAreNow) {
  const auto given = wavy_sheet(4);
  SurfacePoints points = make_points(given);
  const Eigen::Vector3f step(1e-3f, -2e-3f, 5e-3f);
  for (const auto& p : points.grid.points()) points.end_positions.push_back(p + step);
  finish(points);
  auto moved = given;
  for (TestPoint& p : moved) p.position += 0.25 * step.cast<double>();
  const SurfacePoints expected = make_points(moved);

  const ImplicitSurface surface{FieldOptions{}};
  Patch a(2048);
  Patch b(2048);
  const Vector3d x(2e-3, 1e-3, 2e-3);
  a.gather(std::vector<ActiveLayer>{{&points, 0, 1, 0.25, 30}}, 1, x, 2e-3);
  b.gather(one_layer(expected), 1, x, 2e-3);
  EXPECT_EQ(a.points(), b.points());
  EXPECT_NEAR(evaluate(surface, a, x).value, evaluate(surface, b, x).value, 1e-8);
  const PatchSurface mean = mean_surface(surface, a, x);
  EXPECT_LT((mean.velocity - 30 * step.cast<double>()).norm(), 1e-6);
}

TEST(FreeSpace, IsNeverFreeWhereTheFieldIsSolid) {
  const SurfacePoints points = make_points(wavy_sheet(5));
  const auto layers = one_layer(points);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-40e-3, 40e-3);
  int free_balls = 0;
  for (const FieldOptions::Kind kind :
       {FieldOptions::Kind::balanced, FieldOptions::Kind::metaball}) {
    const ImplicitSurface surface{FieldOptions{.kind = kind}};
    Patch patch(2048);
    for (int k = 0; k < 2000; ++k) {
      const Ball ball{{place(random), place(random), place(random)}, std::abs(place(random)) / 4};
      if (!free_space(surface, layers, ball)) continue;
      ++free_balls;
      const Vector3d inside =
          ball.center +
          ball.radius * Vector3d(place(random), place(random), place(random)).normalized();
      patch.gather(layers, 1, inside, 1e-3);
      EXPECT_GT(evaluate(surface, patch, inside).value, 0);
    }
  }
  EXPECT_GT(free_balls, 500);
}

TEST(FreeSpace, AgreesWithThePatchBound) {
  const SurfacePoints points = make_points(wavy_sheet(6));
  const auto layers = one_layer(points);
  const ImplicitSurface surface{FieldOptions{}};
  Patch patch(2048);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> place(-30e-3, 30e-3);
  for (int k = 0; k < 2000; ++k) {
    const Ball ball{{place(random), place(random), place(random)}, std::abs(place(random)) / 3};
    patch.gather(layers, 1, ball.center, ball.radius);
    EXPECT_EQ(is_free(surface, patch, ball), free_space(surface, layers, ball));
  }
}

}  // namespace
}  // namespace palpate
