// How wide the holes beside points are.

#include "refine/holes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace palpate {
namespace {

using Eigen::Vector3f;

constexpr int kAcross = 6;  // points from the middle to the border

/// A square grid of side 1 in z = 0, of the places that are to be there.
CellGrid grid_of(const std::function<bool(int, int)>& is_there) {
  std::vector<Vector3f> points;
  for (int i = -kAcross; i <= kAcross; ++i) {
    for (int j = -kAcross; j <= kAcross; ++j) {
      if (is_there(i, j)) points.emplace_back(static_cast<float>(i), static_cast<float>(j), 0.f);
    }
  }
  return CellGrid(points);
}

/// The radius of the hole beside the point at (x, y), of up to 3.
float beside(const CellGrid& grid, float x, float y, float least = 0.9f,
             const Vector3f& normal = Vector3f::UnitZ()) {
  HoleFinder finder;
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    if ((grid.points()[i] - Vector3f(x, y, 0)).norm() > 1e-3f) continue;
    std::vector<std::uint32_t> near;
    std::vector<std::uint32_t> around;
    grid.within(grid.points()[i], least, near);
    grid.within(grid.points()[i], 3 * least, around);
    return finder.radius_beside(grid, i, near, around, normal, least, 3);
  }
  ADD_FAILURE() << "no point at " << x << ", " << y;
  return 0;
}

TEST(HoleFinder, MeasuresEmptyDiscs) {
  const CellGrid one = grid_of([](int i, int j) { return i != 0 || j != 0; });
  EXPECT_NEAR(beside(one, 1, 0), 1, 1e-5f);
  EXPECT_NEAR(beside(one, 1, 0, 0.9f, -Vector3f::UnitZ()), 1, 1e-5f);
  const CellGrid four = grid_of([](int i, int j) { return i < 0 || i > 1 || j < 0 || j > 1; });
  EXPECT_NEAR(beside(four, -1, 0), std::sqrt(2.5f), 1e-5f);
  EXPECT_NEAR(beside(four, 2, 1), std::sqrt(2.5f), 1e-5f);
}

TEST(HoleFinder, FindsNoneInGridsNorAtBorders) {
  const CellGrid whole = grid_of([](int, int) { return true; });
  for (int i = -kAcross; i <= kAcross; ++i) {
    EXPECT_EQ(beside(whole, static_cast<float>(i), 0), 0);
    EXPECT_EQ(beside(whole, static_cast<float>(i), kAcross), 0);
  }
  EXPECT_NEAR(beside(whole, 0, 0, 0.5f), std::sqrt(0.5f), 1e-5f);
}

TEST(HoleFinder, ABayOfTheBorderIsNone) {
  const CellGrid bay = grid_of([](int i, int j) { return j <= 0 && i * i + j * j >= 5; });
  EXPECT_EQ(beside(bay, 2, -1), 0);
}

TEST(HoleFinder, LooksAsFarAsItIsAsked) {
  const auto ring = [](int i, int j) { return i * i + j * j >= 13; };  // an empty disc of 3.6
  EXPECT_EQ(beside(grid_of(ring), 2, 3), 0);
  const CellGrid one = grid_of([](int i, int j) { return i != 0 || j != 0; });
  EXPECT_EQ(beside(one, 1, 0, 1.1f), 0);
}

TEST(HoleFinder, PassesOverOtherSegments) {
  std::vector<Vector3f> points;
  for (int i = -kAcross; i <= kAcross; ++i) {
    for (int j = -kAcross; j <= kAcross; ++j) {
      const Vector3f place(static_cast<float>(i), static_cast<float>(j), 0);
      if (i != 0 || j != 0) points.push_back(place);
      points.emplace_back(place + Vector3f(0, 0, 2));
    }
  }
  EXPECT_NEAR(beside(CellGrid(points), 1, 0), 1, 1e-5f);
}

}  // namespace
}  // namespace palpate
