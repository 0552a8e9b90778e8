#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palpate/scene/scene_field.hpp"
#include "support/make_points.hpp"
#include "support/snapshots.hpp"
#include "viewer/bytes.hpp"
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
  EXPECT_EQ(cloud.positions.size(), 48u);
  EXPECT_EQ(cloud.normals.size(), 48u);
  for (const auto& place : cloud.positions) {
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
  for (std::size_t k = 0; k < cloud.positions.size(); ++k) {
    EXPECT_EQ(points.grid.points()[cloud.colors[k][0]], cloud.positions[k]);
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

// The middle of a plane: at its border a point weighs more.
float middle_radius(const SurfacePoints& points, std::size_t budget) {
  const CloudMessage cloud = cloud_of(points, Eigen::Vector3d::Zero(), budget);
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    if (cloud.positions[i].norm() < cloud.positions[nearest].norm()) nearest = i;
  }
  return cloud.radii.at(nearest);
}

TEST(CloudOf, APointIsDrawnAsLargeAsItsR) {
  SurfacePoints points = test::make_points(test::plane(0, 4e-3, 15));
  EXPECT_NEAR(middle_radius(points, 1000), 10e-3, 0.5e-3);
  points.end_radii.assign(points.size(), 5e-3F);
  EXPECT_NEAR(middle_radius(points, 1000), 5e-3, 0.25e-3);
}

TEST(CloudOf, WherePointsLieDenselyInRTheyAreDrawnBySpacing) {
  std::vector<test::TestPoint> dense = test::plane(0, 4e-3, 15);
  for (test::TestPoint& point : dense) point.radius = 20e-3;
  EXPECT_NEAR(middle_radius(test::make_points(dense), 5000), 10e-3, 1e-3);
  EXPECT_NEAR(middle_radius(test::make_points(dense, Kernel::wendland), 5000), 10e-3, 1e-3);
}

TEST(CloudOf, WhatIsLeftOfAThinnedCloudIsDrawnSoMuchLarger) {
  const SurfacePoints points = test::make_points(test::plane(0, 4e-3, 15));
  EXPECT_NEAR(middle_radius(points, 240), 20e-3, 1e-3);
}

TEST(CloudOf, ShowsMovingPointsWhereTheyGo) {
  SurfacePoints points = test::make_points(test::plane(0, 4e-3, 3));
  points.end_positions.assign(points.size(), Eigen::Vector3f(1, 2, 3));
  points.end_presences.assign(points.size(), 1.F);
  points.end_presences[0] = 0;
  const CloudMessage cloud = cloud_of(points, Eigen::Vector3d::Zero(), 1000);
  ASSERT_EQ(cloud.positions.size(), 48u);
  EXPECT_EQ(cloud.positions.front(), Eigen::Vector3f(1, 2, 3));
}

TEST(CloudOf, AThinnedSheetIsStillCoveredEverywhere) {
  const SurfacePoints points = test::make_points(test::plane(0, 4e-3, 15));
  const CloudMessage cloud = cloud_of(points, Eigen::Vector3d::Zero(), 240);  // a quarter
  ASSERT_EQ(cloud.positions.size(), 240u);
  for (const auto& p : points.grid.points()) {
    float nearest = 1;
    for (const auto& q : cloud.positions) nearest = std::min(nearest, (p - q).norm());
    EXPECT_LT(nearest, 16e-3F);
  }
}

// A strip whose one half is sampled half as densely, none of it near a tool.
TEST(CloudEncoder, DrawsWhatIsOnlySeenByItsOwnSpacing) {
  SourceOptions options;
  options.policy.clip_to_reach = true;
  options.T_world_sensor = Eigen::Translation3d(0, 0, 5) * Eigen::Isometry3d::Identity();
  Scene scene;
  Source& source = scene.add("sensor", options);
  SceneField field(scene);
  PointCloud cloud;
  for (int i = -40; i < 0; ++i) {
    for (int j = 0; j < 20; ++j) cloud.positions.emplace_back(4e-3F * i, 4e-3F * j, 0);
  }
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 10; ++j) cloud.positions.emplace_back(8e-3F * i, 8e-3F * j, 0);
  }
  for (const double now : {0.0, 0.1}) {
    field.update_from(now, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    ASSERT_TRUE(source.push(cloud, now, [=] { return now + 0.01; }));
  }
  ASSERT_NE(source.state().overview, nullptr);
  const auto encoded = CloudEncoder(scene, Eigen::Vector3d::Zero()).encode({10'000}, 0.1);
  ASSERT_EQ(encoded.size(), 1u);
  const std::string& bytes = *encoded[0].bytes;
  ASSERT_EQ(test::u32(bytes, 4), 1000u);
  const std::size_t radii = bytes.size() - 1000;
  for (std::size_t i = 0; i < 1000; ++i) {
    const double x = -0.16 + 0.312 * test::u16(bytes, 40 + 6 * i) / 65535;
    if (std::abs(x) < 0.02 || std::abs(x) > 0.14) continue;
    const double radius = std::exp2((test::u8(bytes, radii + i) - 160) / 8.0);
    EXPECT_NEAR(radius, x < 0 ? 10e-3 : 20e-3, x < 0 ? 2e-3 : 5e-3) << x;
  }
}

TEST(CloudEncoder, KeepsTheLastCloudOfASilentSensorAndSaysThatItHasFaded) {
  Scene scene;
  Source& source = scene.add("sensor");
  PointCloud cloud;
  for (int i = 0; i < 400; ++i) {
    cloud.positions.emplace_back(4e-3F * static_cast<float>(i % 20),
                                 4e-3F * static_cast<float>(i / 20), 0);
  }
  for (const double now : {0.0, 0.1}) ASSERT_TRUE(source.push(cloud, now, [=] { return now; }));
  CloudEncoder encoder(scene, Eigen::Vector3d::Zero());
  const double gone = source.state().silent_from + source.state().fade + 1;
  const auto flags = [&](double now) {
    const auto encoded = encoder.encode({1000}, now);
    EXPECT_EQ(test::u32(*encoded.at(0).bytes, 4), 400u);
    return test::u16(*encoded.at(0).bytes, 2);
  };
  EXPECT_EQ(flags(0.1) & 16, 0);
  EXPECT_EQ(flags(gone) & 16, 16);
  ASSERT_TRUE(source.push(cloud, gone, [=] { return gone; }));
  EXPECT_EQ(flags(gone) & 16, 0);
}

}  // namespace
}  // namespace palpate::viewer
