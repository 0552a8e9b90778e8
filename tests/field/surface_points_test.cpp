#include "palpate/field/surface_points.hpp"

#include <gtest/gtest.h>

#include <array>

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

TEST(SurfacePoints, BoundsAreThoseOfThePointsInTheWorld) {
  EXPECT_TRUE(SurfacePoints().bounds().empty());
  SurfacePoints points;
  points.origin = Vector3d(1e6, 0, -2);
  points.grid = CellGrid(std::array{Vector3f(0.5f, 1, 0), Vector3f(-0.25f, 3, 1)});
  EXPECT_EQ(points.bounds().lower, Vector3d(1e6 - 0.25, 1, -2));
  EXPECT_EQ(points.bounds().upper, Vector3d(1e6 + 0.5, 3, -1));
}

TEST(SurfacePoints, BoundsHoldWherePointsAreGoing) {
  SurfacePoints points;
  const std::array codes{0u, 1u};
  points.grid.rebuild(std::array{Vector3f(0, 0, 0), Vector3f(1, 0, 0)}, codes,
                      std::array{Vector3f(0, 0, 2), Vector3f(1, -1, 0)});
  EXPECT_EQ(points.bounds().lower, Vector3d(0, -1, 0));
  EXPECT_EQ(points.bounds().upper, Vector3d(1, 0, 2));
}

}  // namespace
}  // namespace palpate
