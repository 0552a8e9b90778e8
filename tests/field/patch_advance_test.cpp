// Patches that follow moving points, and the work of gathering them.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "field/evaluate.hpp"
#include "field/patch.hpp"
#include "support/known_edges.hpp"
#include "support/make_points.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::make_points;
using test::wavy_sheet;

/// A wavy sheet of which every column goes from A to B.
SurfacePoints moving_sheet(unsigned seed) {
  SurfacePoints points = make_points(wavy_sheet(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f way(unit(random), unit(random), unit(random));
    points.end_positions.push_back(points.grid.points()[i] + 8e-3f * way);
    points.end_normals.push_back((points.normals[i] + 0.3f * way).normalized());
    points.end_density_weights.push_back(i % 7 == 0 ? 0 : points.density_weights[i]);
    points.end_radii.push_back(points.radii[i] * (1 + 0.3f * unit(random)));
    points.end_confidences.push_back(0.5f + 0.5f * std::abs(unit(random)));
    points.end_presences.push_back(std::abs(unit(random)));
  }
  points.presences.assign(points.size(), 1);
  test::draw_edges(points, seed);
  points.edges.end = points.edges.start;
  for (SurfacePoints::EdgePlane& edge : points.edges.end) edge.share *= unit(random);
  finish(points);
  return points;
}

/// Two sources; the first one's layers fade into one another, the second one's points are widened.
std::vector<ActiveLayer> layers_at(double u, const std::vector<SurfacePoints>& points) {
  const double rate = u > 0 && u < 1 ? 30 : 0;
  return {{&points[0], 0, 1 - u, u, rate, 1, 0},
          {&points[1], 0, u, u, rate, 1, 1},
          {&points[2], 1, 1, u, rate, 1, 1, 11e-3}};
}

void expect_same(const Patch& a, const Patch& b, const ImplicitSurface& surface,
                 const Vector3d& x) {
  const Sample one = evaluate(surface, a, x);
  const Sample other = evaluate(surface, b, x);
  EXPECT_NEAR(one.value, other.value, 1e-12);
  EXPECT_NEAR(one.support, other.support, 1e-12);
  EXPECT_NEAR(one.radius, other.radius, other.support > 0 ? 1e-12 : 1);
  EXPECT_LT((one.gradient - other.gradient).norm(), 1e-9);
  const PatchSurface on_one = mean_surface(surface, a, x);
  const PatchSurface on_other = mean_surface(surface, b, x);
  EXPECT_NEAR(on_one.presence, on_other.presence, 1e-12);
  EXPECT_LT((on_one.velocity - on_other.velocity).norm(), 1e-9);
  EXPECT_EQ(on_one.source, on_other.source);
}

TEST(PatchAdvance, IsAsGatheringAfresh) {
  std::vector<SurfacePoints> points;
  for (unsigned seed = 1; seed <= 3; ++seed) points.push_back(moving_sheet(seed));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const FieldOptions::Kind kind :
       {FieldOptions::Kind::balanced, FieldOptions::Kind::metaball}) {
    const ImplicitSurface surface{FieldOptions{.kind = kind}};
    for (int k = 0; k < 60; ++k) {
      const Vector3d center = 15e-3 * Vector3d(unit(random), unit(random), 0.3 * unit(random));
      const double extra = 4e-3 * (1 + unit(random)) / 2;
      double u = k % 3 == 0 ? 0 : (1 + unit(random)) / 2;
      Patch advanced(2048);
      Patch afresh(2048);
      ASSERT_TRUE(advanced.gather(layers_at(u, points), 2, center, extra));
      for (int step = 0; step < 5; ++step) {
        u = step == 4 ? 1 : u + (1 - u) * (1 + unit(random)) / 4;
        ASSERT_TRUE(advanced.advance(layers_at(u, points)));
        ASSERT_TRUE(afresh.gather(layers_at(u, points), 2, center, extra));
        const Vector3d way(unit(random), unit(random), unit(random));
        expect_same(advanced, afresh, surface, center + extra * way.normalized());
      }
    }
  }
}

TEST(PatchAdvance, HoldsAllPointsThatAreWidenedIntoIt) {
  const std::vector<SurfacePoints> points = {moving_sheet(1), moving_sheet(2), moving_sheet(3)};
  const ImplicitSurface surface{FieldOptions{}};
  auto layers = layers_at(0.3, points);
  for (ActiveLayer& layer : layers) layer.least_radius = 25e-3;
  Patch all(2048);
  Patch patch(2048);
  ASSERT_TRUE(all.gather(layers, 2, Vector3d::Zero(), 1));
  for (const double x : {-20e-3, 0.0, 13e-3}) {
    ASSERT_TRUE(patch.gather(layers, 2, {x, 0, 2e-3}, 1e-3));
    expect_same(patch, all, surface, {x, 1e-3, 2e-3});
    EXPECT_NEAR(evaluate(surface, all, {x, 1e-3, 2e-3}).radius, 25e-3, 1e-9);
    EXPECT_NEAR(evaluate(surface, all, {x, 1e-3, 2e-3}).support, 1, 0.4) << "of two";
  }
}

TEST(PatchAdvance, RefusesWhatItDoesNotCover) {
  const std::vector<SurfacePoints> points = {moving_sheet(1), moving_sheet(2), moving_sheet(3)};
  Patch patch(2048);
  const auto refused = [&](std::vector<ActiveLayer> layers) {
    EXPECT_TRUE(patch.gather(layers_at(0.5, points), 2, Vector3d::Zero(), 5e-3));
    EXPECT_FALSE(patch.advance(layers));
    EXPECT_FALSE(patch.covers({Vector3d::Zero(), 0}));
  };
  refused(layers_at(0.4, points));  // back in time
  auto fewer = layers_at(0.6, points);
  fewer.pop_back();
  refused(fewer);
  auto others = layers_at(0.6, points);
  others[1].points = points.data();
  refused(others);
  auto wider = layers_at(0.6, points);
  wider[0].least_radius = 12e-3;
  refused(wider);
  EXPECT_TRUE(patch.gather(std::vector<ActiveLayer>{{points.data(), 0, 1, 0.5, 30}}, 1,
                           Vector3d::Zero(), 5e-3));  // without `until`
  EXPECT_FALSE(patch.advance(std::vector<ActiveLayer>{{points.data(), 0, 1, 0.6, 30}}));
}

// A layer that fades in one snapshot and goes on in the next begins again at progress 0.
TEST(PatchAdvance, LayersWhosePointsDoNotChangeMayBeginAgain) {
  const std::vector<test::TestPoint> sheet = test::plane(0);
  const std::vector<SurfacePoints> points = {make_points(sheet), make_points(sheet)};
  const auto layers = [&](double u, double weight) {
    return std::vector<ActiveLayer>{{&points[0], 0, weight, u, 30, 1, 0.5},
                                    {&points[1], 0, 1 - weight, u, 30, 1, 0.5}};
  };
  const ImplicitSurface surface{FieldOptions{}};
  Patch patch(2048);
  Patch afresh(2048);
  ASSERT_TRUE(patch.gather(layers(0.5, 0.9), 1, Vector3d::Zero(), 5e-3));
  for (const double u : {0.8, 0.1, 0.4}) {
    ASSERT_TRUE(patch.advance(layers(u, 0.9 - 0.5 * u)));
    ASSERT_TRUE(afresh.gather(layers(u, 0.9 - 0.5 * u), 1, Vector3d::Zero(), 5e-3));
    expect_same(patch, afresh, surface, {1e-3, 2e-3, 1e-3});
  }
}

TEST(PatchRenew, IsAsGatheringAfreshAndLooksAtChangedLayersAlone) {
  std::vector<SurfacePoints> points;
  for (unsigned seed = 1; seed <= 4; ++seed) points.push_back(moving_sheet(seed));
  const ImplicitSurface surface{FieldOptions{}};
  const double extra = 4e-3;
  const auto layers_with = [&](double u, std::size_t second, double second_u) {
    return std::vector<ActiveLayer>{{&points[0], 0, 1, u, 30, 1, 1},
                                    {&points[second], 1, 1, second_u, 30, 1, 1},
                                    {&points[2], 2, 1, u, 30, 1, 1}};
  };
  Patch renewed(2048);
  Patch afresh(2048);
  ASSERT_TRUE(renewed.gather(layers_with(0, 1, 0), 3, Vector3d::Zero(), extra));
  const int whole = renewed.selection().visits();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 9; ++k) {
    const double u = 0.1 * (k + 1);
    const auto layers = layers_with(u, k % 2 == 0 ? 3 : 1, 0);
    ASSERT_FALSE(renewed.advance(layers));
    EXPECT_TRUE(renewed.outdated());
    ASSERT_TRUE(renewed.renew(layers, 3, 100000));
    EXPECT_FALSE(renewed.outdated());
    EXPECT_LT(renewed.selection().visits(), whole / 2);
    ASSERT_TRUE(renewed.advance(layers_with(u + 0.05, k % 2 == 0 ? 3 : 1, 0.05)));
    ASSERT_TRUE(
        afresh.gather(layers_with(u + 0.05, k % 2 == 0 ? 3 : 1, 0.05), 3, Vector3d::Zero(), extra));
    EXPECT_LE(afresh.points(), renewed.points());
    const Vector3d way(unit(random), unit(random), unit(random));
    expect_same(renewed, afresh, surface, extra * way.normalized());
  }
}

TEST(PatchRenew, LooksAtEverythingAgainWhereThePatchWasThinned) {
  const std::vector<SurfacePoints> points = {moving_sheet(1), moving_sheet(2), moving_sheet(3)};
  Patch patch(256);
  Patch afresh(256);
  ASSERT_TRUE(patch.gather(layers_at(0.5, points), 2, Vector3d::Zero(), 12e-3));
  ASSERT_TRUE(patch.thinned());
  auto layers = layers_at(0.6, points);
  layers.resize(1);
  layers.front().weight = 1;
  ASSERT_FALSE(patch.advance(layers));
  ASSERT_TRUE(patch.renew(layers, 2, 100000));
  ASSERT_TRUE(afresh.gather(layers, 2, Vector3d::Zero(), 12e-3));
  EXPECT_EQ(patch.points(), afresh.points());
}

TEST(PatchRenew, CoversNothingWhenItsVisitsAreSpent) {
  const std::vector<SurfacePoints> points = {moving_sheet(1), moving_sheet(2), moving_sheet(3)};
  Patch patch(2048);
  ASSERT_TRUE(patch.gather(layers_at(0.5, points), 2, Vector3d::Zero(), 5e-3));
  ASSERT_FALSE(patch.advance(layers_at(0.4, points)));
  EXPECT_FALSE(patch.renew(layers_at(0.4, points), 2, 10));
  EXPECT_FALSE(patch.reaches({Vector3d::Zero(), 0}));
}

TEST(PatchAdvance, GatheringStopsWhenItsVisitsAreSpent) {
  const std::vector<SurfacePoints> points = {moving_sheet(1), moving_sheet(2), moving_sheet(3)};
  const auto layers = layers_at(0.5, points);
  Patch patch(2048);
  ASSERT_TRUE(patch.gather(layers, 2, Vector3d::Zero(), 5e-3));
  const int needed = patch.selection().visits();
  const std::size_t count = patch.points();
  for (int most = 0; most < needed; most += 7) {
    EXPECT_FALSE(patch.gather(layers, 2, Vector3d::Zero(), 5e-3, {.most_visits = most}));
    EXPECT_LE(patch.selection().visits(), most);
    EXPECT_FALSE(patch.covers({Vector3d::Zero(), 0}));
  }
  EXPECT_TRUE(patch.gather(layers, 2, Vector3d::Zero(), 5e-3, {.most_visits = needed}));
  EXPECT_EQ(patch.points(), count);
}

TEST(PatchAdvance, ManyPointsAreThinnedInOneWalk) {
  std::vector<Eigen::Vector3f> places;
  for (int i = 0; i < 600; ++i) {
    for (int j = 0; j < 600; ++j) places.emplace_back(1e-5f * i, 1e-5f * j, 0.0f);
  }
  SurfacePoints points;
  points.grid = CellGrid(places);
  points.normals.assign(points.size(), Eigen::Vector3f::UnitZ());
  points.density_weights.assign(points.size(), 1e-5f);
  points.radii.assign(points.size(), 20e-3f);
  points.confidences.assign(points.size(), 1);
  finish(points);
  Patch patch(2048);
  ASSERT_TRUE(patch.gather(std::vector<ActiveLayer>{{&points}}, 1, {3e-3, 3e-3, 0}, 10e-3));
  EXPECT_TRUE(patch.thinned());
  EXPECT_GT(patch.points(), 1024u);
  EXPECT_LT(patch.selection().visits(), 30000);  // of 360 000 points
}

/// The bound of is_free_space by brute force: can the united weights reach the level?
bool brute_free(const ImplicitSurface& surface, const std::vector<ActiveLayer>& layers,
                const Ball& ball, double smallest) {
  double w[simd::kMaxSources] = {};
  for (const ActiveLayer& layer : layers) {
    for (std::uint32_t i = 0; i < layer.points->size(); ++i) {
      const double distance = position_now(layer, i, ball.center).norm();
      const double r = std::max(0.0, distance - ball.radius) / radius_now(layer, i);
      w[layer.source] += weight_now(layer, i, false) * evaluate(surface.options.kernel, r * r).w;
    }
  }
  return united(w, 2) < free_level(surface, smallest);
}

TEST(FreeSpaceWork, IsBoundedAndNeverSaysFreeWithoutKnowing) {
  const std::vector<SurfacePoints> points = {moving_sheet(1), moving_sheet(2), moving_sheet(3)};
  double smallest = 1;
  for (const SurfacePoints& p : points) smallest = std::min(smallest, p.smallest_radius);
  const ImplicitSurface surface{FieldOptions{}};
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  int agreed = 0;
  int free_balls = 0;
  for (int k = 0; k < 600; ++k) {
    const auto layers = layers_at((1 + unit(random)) / 2, points);
    const Ball ball{40e-3 * Vector3d(unit(random), unit(random), unit(random)),
                    12e-3 * std::abs(unit(random))};
    const bool expected = brute_free(surface, layers, ball, smallest);
    int plenty = 1 << 20;
    agreed += is_free_space(surface, layers, 2, ball, 0, plenty) == expected ? 1 : 0;
    free_balls += expected ? 1 : 0;
    for (const int most : {1, 10, 100, 1000}) {
      int left = most;
      const bool free = is_free_space(surface, layers, 2, ball, 0, left);
      EXPECT_GE(left, 0);
      EXPECT_TRUE(expected || !free);
    }
  }
  EXPECT_EQ(agreed, 600);
  EXPECT_GT(free_balls, 100);
  EXPECT_LT(free_balls, 500);
}

TEST(FreeSpaceWork, ALayerThatIsFarAwayIsOneLook) {
  const SurfacePoints points = moving_sheet(1);
  const std::vector<ActiveLayer> layers(20, ActiveLayer{&points});
  const ImplicitSurface surface{FieldOptions{}};
  int left = 21;
  EXPECT_TRUE(is_free_space(surface, layers, 1, {Vector3d(1, 1, 1), 1e-3}, 0, left));
  EXPECT_EQ(left, 1);
}

}  // namespace
}  // namespace palpate
