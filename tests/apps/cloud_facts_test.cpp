#include "apps/palpate/sources/cloud_facts.hpp"

#include <gtest/gtest.h>

#include "palpate/io/synthetic.hpp"

namespace palpate::app {
namespace {

TEST(CloudFacts, PlacesAndLinesHaveNoSurface) {
  const Eigen::Vector3f a(0.5f, 0.1f, -3.f);
  const Eigen::Vector3f way(0.3f, 0.1f, 0.2f);
  EXPECT_TRUE(on_a_line({}));
  EXPECT_TRUE(on_a_line(std::vector{a, a, a}));
  EXPECT_TRUE(on_a_line(std::vector{a, Eigen::Vector3f(a + way), a, Eigen::Vector3f(a + 7 * way)}));
  EXPECT_FALSE(on_a_line(std::vector{a, Eigen::Vector3f(a + way), Eigen::Vector3f(way)}));
}

TEST(CloudFacts, SpacingIsTheSquareGridsOwn) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 10000; ++i) {
    points.emplace_back(0.01f * static_cast<float>(i % 100), 0.01f * static_cast<float>(i / 100),
                        0.f);
  }
  EXPECT_NEAR(nearest_three(CellGrid(points)), 0.01, 1e-5);
  EXPECT_NEAR(spacing_from_area(CellGrid(points)), 0.01, 1e-5);
}

TEST(CloudFacts, ClosedSurfaceHasNoRimAndASheetHasOne) {
  EXPECT_LT(rim_share(prepare(synthetic_cloud("sphere")).points), 0.002);
  const double sheet = rim_share(prepare(synthetic_cloud("sheet")).points);
  EXPECT_GT(sheet, 0.01);
  EXPECT_LT(sheet, 0.12);
}

TEST(CloudFacts, OnePointIsAllRim) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}};
  EXPECT_EQ(spacing_from_area(CellGrid(cloud.positions)), 0);
  EXPECT_EQ(rim_share(prepare(cloud).points), 1);
}

}  // namespace
}  // namespace palpate::app
