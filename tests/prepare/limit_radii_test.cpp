// R varies slowly from point to point.

#include "prepare/limit_radii.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "prepare/plane_fits.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

std::vector<Vector3f> scattered(std::size_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(0, 1);
  std::vector<Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(place(random), place(random), 0.0f);
  return points;
}

TEST(LimitRadii, IsTheLowestConeOverAllPoints) {
  const CellGrid grid(scattered(600));
  std::mt19937 random(6);
  std::uniform_real_distribution<float> size(-4, 0);
  std::vector<float> radii;
  for (std::size_t i = 0; i < grid.size(); ++i) radii.push_back(std::pow(10.0f, size(random)));
  std::vector<float> limited = radii;
  limit_radii(grid, 0.5f, limited);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    float expected = radii[i];
    for (std::size_t j = 0; j < grid.size(); ++j) {
      expected = std::min(expected, radii[j] + 0.5f * (grid.points()[j] - grid.points()[i]).norm());
    }
    // Limits that are hardly below the radius itself are not worth applying.
    if (expected > 0.8f * radii[i]) expected = radii[i];
    EXPECT_NEAR(limited[i], expected, 1e-6f);
  }
}

TEST(LimitRadii, LeavesEvenRadiiAlone) {
  const CellGrid grid(scattered(100));
  const std::vector<float> even(100, 0.1f);
  std::vector<float> radii = even;
  limit_radii(grid, 0.5f, radii);
  EXPECT_EQ(radii, even);
  std::vector<float> none;
  limit_radii(CellGrid(), 0.5f, none);
  EXPECT_TRUE(none.empty());
}

TEST(LimitRadii, SparsePointsDoNotReachIntoFineSampling) {
  std::vector<Vector3f> points = scattered(1000);  // 3 cm apart
  points.emplace_back(2.0f, 0.5f, 0.0f);
  const CellGrid grid(points);
  std::vector<float> radii;
  for (const Vector3f& p : grid.points()) radii.push_back(p.x() > 1.5f ? 5.0f : 0.08f);
  limit_radii(grid, 0.5f, radii);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (grid.points()[i].x() > 1.5f) {
      EXPECT_LT(radii[i], 0.6f);
    }
  }
}

TEST(LimitRadii, SparsePointsOfTheSamePlaneMayReach) {
  std::vector<Vector3f> points = scattered(1000);
  points.emplace_back(2.0f, 0.5f, 0.0f);
  points.emplace_back(2.0f, 0.5f, 1.0f);
  const CellGrid grid(points);
  std::vector<float> radii;
  for (const Vector3f& p : grid.points()) radii.push_back(p.x() > 1.5f ? 5.0f : 0.08f);
  const PointFits own{std::vector<Vector3f>(points.size(), Vector3f(0, 0, -1)),
                      std::vector<float>(points.size(), 1.0f),
                      std::vector<float>(points.size(), 0.0f),
                      {},
                      {},
                      {}};
  limit_radii(grid, 0.5f, radii, &own);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Vector3f& p = grid.points()[i];
    if (p.x() < 1.5f) continue;
    EXPECT_EQ(radii[i] == 5.0f, p.z() < 0.5f);
  }
}

}  // namespace
}  // namespace palpate
