#include <gtest/gtest.h>

#include "field/evaluate.hpp"
#include "palpate/base/error.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::make_points;

/// Two points 8 mm apart on the x axis, of 10 mm radius; the grid keeps them in this order.
SurfacePoints two_points() {
  SurfacePoints points = make_points({{.position = {0, 0, 0}}, {.position = {8e-3, 0, 0}}});
  EXPECT_LT(points.grid.points()[0].x(), points.grid.points()[1].x());
  return points;
}

double presence_at(const SurfacePoints& points, double x, double progress = 0) {
  Patch patch(64);
  const std::vector<ActiveLayer> layers{{.points = &points, .progress = progress, .rate = 30}};
  patch.gather(layers, 1, Vector3d::Zero(), 20e-3);
  return mean_surface(ImplicitSurface{FieldOptions{}}, patch, {x, 0, 0}).presence;
}

TEST(MeanSurface, PointsWithoutAPresenceAreSure) {
  EXPECT_EQ(presence_at(two_points(), 3e-3), 1);
}

TEST(MeanSurface, PresenceIsTheWeightedMean) {
  SurfacePoints points = two_points();
  points.presences = {1, 0.25F};
  EXPECT_EQ(presence_at(points, -5e-3), 1);  // the other point is out of reach
  EXPECT_NEAR(presence_at(points, 4e-3), 0.625, 1e-6);
  EXPECT_EQ(presence_at(points, 13e-3), 0.25);
}

TEST(MeanSurface, PresenceGoesInAStraightLine) {
  SurfacePoints points = two_points();
  points.end_presences = {0.5F, 0};
  EXPECT_EQ(presence_at(points, -5e-3, 0), 1);
  EXPECT_EQ(presence_at(points, -5e-3, 0.5), 0.75);
  EXPECT_EQ(presence_at(points, 13e-3, 0.75), 0.25);
  points.presences = {0.5F, 0.5F};
  EXPECT_EQ(presence_at(points, 13e-3, 0.5), 0.25);
  points.end_presences.clear();
  EXPECT_EQ(presence_at(points, 13e-3, 0.5), 0.5);
}

TEST(MeanSurface, PresencesThatAreNotWholeOrOutOfRangeAreRefused) {
  SurfacePoints points = two_points();
  EXPECT_NO_THROW(check(points));
  points.presences = {1};
  EXPECT_THROW(check(points), Error);
  points.presences = {1, 1.5F};
  EXPECT_THROW(check(points), Error);
  points.presences = {0, 1};
  EXPECT_NO_THROW(check(points));
  points.end_presences = {0, -0.5F};
  EXPECT_THROW(check(points), Error);
}

}  // namespace
}  // namespace palpate
