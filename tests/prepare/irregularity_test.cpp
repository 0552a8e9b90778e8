// Random points are told from regular ones.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "palpate/geometry/spacing.hpp"
#include "prepare/radii.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr int kSide = 60;

/// A square grid of 10 mm whose points are off their places by up to `jitter` spacings.
CellGrid grid_with(float jitter) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> off(-jitter, jitter);
  std::vector<Vector3f> points;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const float x = static_cast<float>(i) + off(random);
      points.emplace_back(0.01f * x, 0.01f * (static_cast<float>(j) + off(random)), 0.0f);
    }
  }
  return CellGrid(points);
}

CellGrid random_points() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(0, 1);
  std::vector<Vector3f> points;
  for (int i = 0; i < 5000; ++i) points.emplace_back(place(random), place(random), 0.0f);
  return CellGrid(points);
}

TEST(Irregularity, TellsGridsFromChance) {
  const CellGrid even = grid_with(0);
  EXPECT_NEAR(nearest_share(even, local_spacings(even)), 1, 0.01);
  const CellGrid jittered = grid_with(0.3f);
  EXPECT_FALSE(is_irregular(jittered, local_spacings(jittered)));
  const CellGrid chance = random_points();
  EXPECT_NEAR(nearest_share(chance, local_spacings(chance)), 0.5, 0.06);
  EXPECT_TRUE(is_irregular(chance, local_spacings(chance)));
}

TEST(Irregularity, FewPointsOrOnePlaceSayNothing) {
  EXPECT_EQ(nearest_share(CellGrid(), {}), 1);
  const CellGrid pile(std::vector<Vector3f>(500, Vector3f(1, 2, 3)));
  EXPECT_EQ(nearest_share(pile, local_spacings(pile)), 1);
}

}  // namespace
}  // namespace palpate
