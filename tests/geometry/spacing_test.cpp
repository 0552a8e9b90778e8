#include "palpate/geometry/spacing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/clouds.hpp"
#include "palpate/base/error.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;
using test::Clouds;
using test::Points;

double brute_mean_spacing(const Points& points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<double> distances;
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (j != i) distances.push_back((points[i] - points[j]).cast<double>().norm());
    }
    std::sort(distances.begin(), distances.end());
    const std::size_t others = std::min<std::size_t>(3, distances.size());
    for (std::size_t n = 0; n < others; ++n) sum += distances[n] / static_cast<double>(others);
  }
  return sum / static_cast<double>(points.size());
}

double median_spacing(const Points& points) {
  return median(local_spacings(CellGrid(points)));
}

TEST(MeanSpacing, EqualsBruteForce) {
  Clouds clouds;
  Points points = clouds.sphere(700, 0.1);
  points.insert(points.end(), 20, points.front());                      // coincide
  for (const Vector3f& p : clouds.cube(60, 1e-3)) points.push_back(p);  // much denser
  points.push_back(Vector3f(50, 0, 0));                                 // far off
  const CellGrid grid(points);
  const double expected = brute_mean_spacing(points);
  EXPECT_NEAR(mean_spacing(grid), expected, 1e-6 * expected);
}

TEST(MeanSpacing, IsDefinedForTheSmallestClouds) {
  EXPECT_EQ(mean_spacing(CellGrid(Points{})), kLoneSpacing);
  EXPECT_EQ(mean_spacing(CellGrid(Points(1, Vector3f(1, 1, 1)))), kLoneSpacing);
  EXPECT_EQ(mean_spacing(CellGrid(Points(50, Vector3f(1, 1, 1)))), kLoneSpacing);
  const Points two{Vector3f(0, 0, 0), Vector3f(0, 0.25f, 0)};
  EXPECT_FLOAT_EQ(static_cast<float>(mean_spacing(CellGrid(two))), 0.25f);
  const Points three{Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(3, 0, 0)};
  EXPECT_FLOAT_EQ(static_cast<float>(mean_spacing(CellGrid(three))), 2);
}

TEST(LocalSpacings, AreThoseOfASquareGrid) {
  Clouds clouds;
  const auto spacings = local_spacings(CellGrid(clouds.plane(60, 4e-3)));
  EXPECT_NEAR(median(spacings), 4e-3, 1e-6);
  EXPECT_GT(*std::min_element(spacings.begin(), spacings.end()), 3.99e-3f);
  EXPECT_LT(*std::max_element(spacings.begin(), spacings.end()), 6e-3f);  // at the rim
}

TEST(LocalSpacings, AreNearTheRootOfTheAreaWhereTheGridIsJittered) {
  for (const double jitter : {0.1, 0.2, 0.3, 0.5}) {
    EXPECT_NEAR(median_spacing(Clouds(7).plane(60, 4e-3, jitter)), 4e-3, 0.06 * 4e-3) << jitter;
  }
  const double area = 4 * 3.14159 * 0.01;
  const double spacing =
      std::sqrt(area / 8000);  // scattered at random: points see more than there are
  EXPECT_NEAR(median_spacing(Clouds(3).sphere(8000, 0.1)), spacing, 0.1 * spacing);
}

TEST(LocalSpacings, FollowGradedDensity) {
  Points points = Clouds(1).plane(60, 2e-3);  // x < 0.12
  for (Vector3f p : Clouds(1).plane(30, 8e-3)) points.push_back(p + Vector3f(0.126f, 0, 0));
  const CellGrid grid(points);
  const auto spacings = local_spacings(grid);
  ASSERT_EQ(spacings.size(), grid.size());
  for (std::size_t i = 0; i < spacings.size(); ++i) {
    const float x = grid.points()[i].x();
    EXPECT_TRUE(x >= 0.10f || spacings[i] < 3.2e-3f) << spacings[i];
    EXPECT_TRUE(x <= 0.17f || spacings[i] > 7.9e-3f) << spacings[i];
    EXPECT_GT(spacings[i], 1.9e-3f);
  }
}

TEST(LocalSpacings, OfAnOutlierStayNearThoseOfTheSurface) {
  Points points = Clouds(1).plane(60, 2e-3);
  points.push_back(Vector3f(0.06f, 0.06f, 0.5f));
  const CellGrid grid(points);
  const auto spacings = local_spacings(grid);
  ASSERT_EQ(spacings.size(), grid.size());
  for (const float s : spacings) EXPECT_LT(s, 6e-3f);
}

TEST(LocalSpacings, AreFiniteAndPositiveWhateverThePoints) {
  std::vector<Points> inputs{Points(1, Vector3f(1, 2, 3)), Points(2000, Vector3f(1, 2, 3))};
  inputs.push_back({Vector3f(0, 0, 0), Vector3f(1, 0, 0)});
  inputs.push_back({Vector3f(0, 0, 0), Vector3f(1e-30f, 0, 0), Vector3f(1e30f, 0, 0)});
  Points line;
  for (int i = 0; i < 100; ++i) line.push_back(Vector3f(static_cast<float>(i), 5e5f, 0));
  inputs.push_back(line);
  Points thin;  // the two short extents vanish beside the long one, and their sum rounds below 0
  for (int i = 0; i < 50; ++i) {
    const auto t = static_cast<float>(i);
    thin.push_back(Vector3f(4.1e-11F * t, 4.1e-11F * t, 0.1F * t));
  }
  inputs.push_back(thin);
  Points doubled = Clouds(2).sphere(500, 0.1);
  doubled.insert(doubled.end(), doubled.begin(), doubled.end());
  inputs.push_back(doubled);
  inputs.push_back({});
  for (const Points& points : inputs) {
    const auto spacings = local_spacings(CellGrid(points));
    ASSERT_EQ(spacings.size(), points.size());
    for (const float s : spacings) EXPECT_TRUE(std::isfinite(s) && s > 0) << s;
  }
}

TEST(LocalSpacings, DoNotDependOnTheNumberOfThreads) {
  const CellGrid grid(Clouds(5).sphere(20000, 0.1));
  const auto many = local_spacings(grid);
  const double mean = mean_spacing(grid);
  const ThreadLimit one(1);
  EXPECT_EQ(many, local_spacings(grid));
  EXPECT_EQ(mean, mean_spacing(grid));
}

}  // namespace
}  // namespace palpate
