#include <gtest/gtest.h>

#include <cmath>

#include "geometry/clouds.hpp"
#include "palpate/base/error.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/weights.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using test::Clouds;
using test::Points;

TEST(Clip, KeepsWhatIsInsideWithAllItsColumns) {
  PointCloud cloud;
  cloud.origin = Vector3d(1000, 0, 0);
  for (int i = 0; i < 10; ++i) {
    cloud.positions.push_back(Vector3f(static_cast<float>(i), 0, 0));
    cloud.intensities.push_back(static_cast<float>(i));
    cloud.colors.push_back({static_cast<std::uint8_t>(i), 0, 0});
  }
  Box box;
  box.extend(Vector3d(1003, -1, -1));
  box.extend(Vector3d(1005, 1, 1));
  const PointCloud clipped = clip(cloud, box);
  ASSERT_EQ(clipped.size(), 3u);
  EXPECT_EQ(clipped.origin, cloud.origin);
  EXPECT_EQ(clipped.intensities, (std::vector<float>{3, 4, 5}));
  EXPECT_EQ(clipped.colors[2][0], 5);
  EXPECT_TRUE(clipped.normals.empty());
  EXPECT_TRUE(clip(cloud, Box{}).empty());
}

detail::NeighborhoodGraph graph_of(const CellGrid& grid, const std::vector<float>& radii) {
  return detail::NeighborhoodGraph(grid, radii, radii);
}

std::vector<std::uint8_t> mask_of(const CellGrid& grid) {
  std::vector<float> radii = local_spacings(grid);
  for (float& radius : radii) radius *= 2.5f;
  return radius_outliers(grid, radii, WeightSums(graph_of(grid, radii), radii).own);
}

TEST(Speckle, IsWhatFloatsAroundASurfaceAndNothingOfIt) {
  Clouds clouds;
  Points points = clouds.plane(60, 2e-3, 0.3);
  const std::size_t surface = points.size();
  for (int i = 0; i < 4; ++i) {
    points.push_back(Vector3f(0.04f * static_cast<float>(i), 0.03f * static_cast<float>(3 - i),
                              0.015f + 0.04f * static_cast<float>(i)));
  }
  const CellGrid grid(points);
  const auto mask = mask_of(grid);
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < mask.size(); ++k) {
    if ((mask[k] != 0) != (grid.order()[k] >= surface)) ++wrong;
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(Speckle, LeavesALineAndASphereAlone) {
  Points line;
  for (int i = 0; i < 100; ++i) line.push_back(Vector3f(0.01f * static_cast<float>(i), 0, 0));
  for (const Points& points : {line, Clouds(2).sphere(3000, 0.1)}) {
    std::size_t dropped = 0;
    for (const auto speckle : mask_of(CellGrid(points))) dropped += speckle;
    EXPECT_EQ(dropped, 0u);
  }
}

TEST(WeightSums, WantARadiusForEachPoint) {
  const CellGrid grid(Clouds(1).plane(3, 1));
  const detail::NeighborhoodGraph graph = graph_of(grid, std::vector<float>(9, 1.f));
  EXPECT_THROW(WeightSums(graph, std::vector<float>(3, 1.f)), Error);
  EXPECT_THROW(WeightSums(graph, std::vector<float>(9, 0.f)), Error);
}

TEST(WeightSums, FollowRadiiThatChangeAsIfSummedAnew) {
  Clouds clouds(3);
  const CellGrid grid(clouds.sphere(4000, 1));
  const std::vector<float> before(grid.size(), 0.1f);
  std::vector<float> after = before;
  for (const std::size_t i : {7u, 8u, 2000u, 3999u}) {
    after[i] = static_cast<float>(clouds.uniform(0.02, 0.3));
  }
  detail::NeighborhoodGraph graph = graph_of(grid, before);
  graph.keep();
  WeightSums sums(graph, before);
  graph.widen(after, after);
  sums.update(graph, before, after);
  const WeightSums anew(graph_of(grid, after), after);
  EXPECT_EQ(sums.own, anew.own);
  EXPECT_EQ(sums.around, anew.around);
}

}  // namespace
}  // namespace palpate
