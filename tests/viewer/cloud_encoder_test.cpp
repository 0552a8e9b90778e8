#include <gtest/gtest.h>

#include <algorithm>

#include "support/make_points.hpp"
#include "support/snapshots.hpp"
#include "viewer/scene_encoder.hpp"

namespace palpate::viewer {
namespace {

TEST(Thinned, KeepsAllWhereThereIsRoom) {
  EXPECT_EQ(thinned(3, 3), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(thinned(3, 100), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(thinned(0, 100).empty());
  EXPECT_TRUE(thinned(100, 0).empty());
}

TEST(Thinned, TakesOneOfEveryStretchAndTheSameAgain) {
  for (const std::size_t budget : {1u, 7u, 100u, 999u}) {
    const auto kept = thinned(1000, budget);
    ASSERT_EQ(kept.size(), budget);
    EXPECT_EQ(kept, thinned(1000, budget));
    for (std::size_t i = 0; i < budget; ++i) {
      EXPECT_GE(kept[i], i * 1000 / budget);
      EXPECT_LT(kept[i], (i + 1) * 1000 / budget);
    }
  }
}

TEST(Thinned, SharesABudgetInProportion) {
  EXPECT_EQ(shares({10, 20}, 100), (std::vector<std::size_t>{10, 20}));
  EXPECT_EQ(shares({1000, 3000}, 100), (std::vector<std::size_t>{25, 75}));
  EXPECT_EQ(shares({0, 3000}, 100), (std::vector<std::size_t>{0, 100}));
  EXPECT_TRUE(shares({}, 100).empty());
}

TEST(CloudOf, GivesTheFeltPointsRelativeToTheOrigin) {
  SurfacePoints points = test::make_points(test::plane(0.5, 4e-3, 3));
  points.origin = {1000, 0, 0};
  points.density_weights[5] = 0;
  const CloudMessage cloud = cloud_of(points, {999, 0, 0.25}, 1000);
  EXPECT_EQ(cloud.places.size(), 48u);
  EXPECT_EQ(cloud.normals.size(), 48u);
  for (const auto& place : cloud.places) {
    EXPECT_NEAR(place.x(), 1, 0.0121);
    EXPECT_FLOAT_EQ(place.z(), 0.25F);
  }
}

TEST(CloudOf, ColoursStayWithTheirPoints) {
  SurfacePoints points = test::make_points(test::plane(0, 4e-3, 3));
  EXPECT_TRUE(cloud_of(points, Eigen::Vector3d::Zero(), 1000).colors.empty());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.colors.push_back({static_cast<std::uint8_t>(i), 1, 2});
  }
  const CloudMessage cloud = cloud_of(points, Eigen::Vector3d::Zero(), 10);
  ASSERT_EQ(cloud.colors.size(), 10u);
  for (std::size_t k = 0; k < cloud.places.size(); ++k) {
    EXPECT_EQ(points.grid.points()[cloud.colors[k][0]], cloud.places[k]);
  }
}

TEST(CloudOf, TrustStaysWithItsPointsAndIsAByteWhoseUpperHalfIsTrusted) {
  SurfacePoints points = test::make_points(test::plane(0, 4e-3, 3));
  points.confidences.assign(points.size(), 0.499F);
  points.confidences[1] = 0.5F;
  points.confidences[2] = 1;
  const CloudMessage cloud = cloud_of(points, Eigen::Vector3d::Zero(), 1000);
  ASSERT_EQ(cloud.trust.size(), points.size());
  EXPECT_EQ(cloud.trust[0], 127);
  EXPECT_EQ(cloud.trust[1], 128);
  EXPECT_EQ(cloud.trust[2], 255);
  points.end_confidences.assign(points.size(), 0.F);
  EXPECT_EQ(cloud_of(points, Eigen::Vector3d::Zero(), 10).trust, std::vector<std::uint8_t>(10));
}

TEST(CloudOf, ShowsMovingPointsWhereTheyGo) {
  SurfacePoints points = test::make_points(test::plane(0, 4e-3, 3));
  points.end_positions.assign(points.size(), Eigen::Vector3f(1, 2, 3));
  points.end_presences.assign(points.size(), 1.F);
  points.end_presences[0] = 0;
  const CloudMessage cloud = cloud_of(points, Eigen::Vector3d::Zero(), 1000);
  ASSERT_EQ(cloud.places.size(), 48u);
  EXPECT_EQ(cloud.places.front(), Eigen::Vector3f(1, 2, 3));
}

TEST(CloudOf, AThinnedSheetIsStillCoveredEverywhere) {
  const SurfacePoints points = test::make_points(test::plane(0, 4e-3, 15));
  const CloudMessage cloud = cloud_of(points, Eigen::Vector3d::Zero(), 240);  // a quarter
  ASSERT_EQ(cloud.places.size(), 240u);
  for (const auto& p : points.grid.points()) {
    float nearest = 1;
    for (const auto& q : cloud.places) nearest = std::min(nearest, (p - q).norm());
    EXPECT_LT(nearest, 16e-3F);
  }
}

}  // namespace
}  // namespace palpate::viewer
