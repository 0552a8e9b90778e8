// What is an isolated outlier: a point far from others whose nearest make neither a surface nor a
// line.
#include "refine/outliers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "palpate/geometry/spacing.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr float kGridSpacing = 0.01f;

/// A grid of 60 x 60 points, and others of which the test asks.
class Outliers : public testing::Test {
 protected:
  Outliers() {
    for (int i = 0; i < 60; ++i) {
      for (int j = 0; j < 60; ++j) add(static_cast<float>(i), static_cast<float>(j), 0);
    }
    first_ = points_.size();
  }

  /// In spacings.
  void add(float x, float y, float z) { points_.emplace_back(kGridSpacing * Vector3f(x, y, z)); }
  [[nodiscard]] float between(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }

  /// How many of the grid's points and how many of the others are outliers.
  std::pair<int, int> count() {
    const CellGrid grid(points_);
    const std::vector<float> spacings = local_spacings(grid);
    const std::vector<std::uint8_t> outliers = find_outliers(grid, spacings, median(spacings));
    std::pair<int, int> counts{0, 0};
    for (std::size_t i = 0; i < outliers.size(); ++i) {
      (grid.order()[i] < first_ ? counts.first : counts.second) += outliers[i];
    }
    return counts;
  }

  /// Adds points over and under the sheet, no nearer to its border than `inside` and at heights
  /// from `low` to `high`.
  void scatter(int count, float inside, float low, float high) {
    for (int i = 0; i < count; ++i) {
      const float x = between(inside, 60 - inside);
      const float y = between(inside, 60 - inside);
      const float z = between(low, high);
      add(x, y, i % 2 == 0 ? z : -z);
    }
  }

  /// How many of the grid's points and how many of the others weigh nothing once prepared.
  std::pair<int, int> count_weightless(const PrepareOptions& options = {}) {
    PointCloud cloud;
    cloud.positions = points_;
    const SurfacePoints prepared = prepare(cloud, options).points;
    std::pair<int, int> counts{0, 0};
    for (std::size_t i = 0; i < prepared.size(); ++i) {
      if (prepared.density_weights[i] > 0) continue;
      // A point on two segments is there twice, so order() does not tell which it was.
      const double height =
          prepared.origin.z() + static_cast<double>(prepared.grid.points()[i].z());
      ++(std::abs(height) < 0.5 * kGridSpacing ? counts.first : counts.second);
    }
    return counts;
  }

  std::vector<Vector3f> points_;
  std::size_t first_ = 0;
  std::mt19937 random_{4};
};

TEST_F(Outliers, AreWhatLiesEverywhereAroundASheet) {
  scatter(500, 0, 5, 30);
  const auto [own, others] = count();
  EXPECT_EQ(own, 0);
  EXPECT_GT(others, 400);
}

// Such is an object far from the scanner, beside one that is near. Along its edges the nearest
// make no sheet, and most of them are in none: some are lost there.
TEST_F(Outliers, AreNoFacesOfABoxThatIsSparse) {
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      const float a = 4 * static_cast<float>(i);
      const float b = 4 * static_cast<float>(j);
      add(100 + a, b, 0);
      if (j > 0) add(100 + a, 0, -b);
      if (i > 0 && j > 0) add(100, a, -b);
    }
  }
  const auto [own, others] = count();
  EXPECT_EQ(own, 0);
  EXPECT_LE(others, 90);  // of 397
}

TEST_F(Outliers, AreNoSparsePartsWhosePointsLieAnywhere) {
  for (int i = 0; i < 300; ++i) {
    const float x = between(70, 140);
    const float y = between(0, 70);
    add(x, y, 0);
    if (i % 3 == 0) add(x + 0.1f, y, 0.05f);  // seen twice
  }
  const auto [own, others] = count();
  EXPECT_EQ(own, 0);
  EXPECT_LE(others, 4);
}

TEST_F(Outliers, AreNoPartsOfASheetThatAreSparse) {
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 16; ++j) {
      const float x = static_cast<float>(i) + between(-0.3f, 0.3f);
      add(64 + 4 * x, 4 * static_cast<float>(j), 0);
    }
  }
  EXPECT_EQ(count(), std::pair(0, 0));
}

TEST_F(Outliers, AreNoPointsWithinASparseWire) {
  for (int i = 0; i < 30; ++i) add(0, 4 * static_cast<float>(i), 40);
  const auto [own, others] = count();
  EXPECT_EQ(own, 0);
  EXPECT_LE(others, 8);  // its ends, where the nearest lie on one side
}

TEST_F(Outliers, AreClustersFarFromTheRest) {
  for (int i = 0; i < 4; ++i) add(200 + 0.4f * static_cast<float>(i), 200, i % 2 == 0 ? 0.f : 0.7f);
  add(-300, 0, 20);
  EXPECT_EQ(count(), std::pair(0, 5));
}

// The sheet's points are their nearest, so they are outliers among what is on no segment alone.
TEST_F(Outliers, BesideASheetWeighNothing) {
  scatter(300, 3, 1.3f, 4);
  const auto [own, others] = count_weightless();
  EXPECT_EQ(own, 0);
  EXPECT_GE(others, 200);
}

TEST_F(Outliers, WeighNothingWhereTheRadiusIsGiven) {
  scatter(500, 0, 5, 30);
  const auto [own, others] = count_weightless({.radius = 3 * kGridSpacing});
  EXPECT_EQ(own, 0);
  EXPECT_GT(others, 400);
}

TEST_F(Outliers, AreNoWiresThatBeginAtASheet) {
  for (int i = 1; i < 25; ++i) add(30.4f, 30.3f, static_cast<float>(i));
  EXPECT_EQ(count_weightless(), std::pair(0, 0));
}

}  // namespace
}  // namespace palpate
