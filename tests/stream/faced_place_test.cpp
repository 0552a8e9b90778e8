// Which places a cloud's normals face.
#include "stream/faced_place.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/point_shapes.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

PointCloud cloud_of(const std::vector<TestPoint>& points) {
  PointCloud cloud;
  for (const TestPoint& p : points) {
    cloud.positions.push_back(p.position.cast<float>());
    cloud.normals.push_back(p.normal.cast<float>());
  }
  return cloud;
}

std::size_t count_facing(const PointCloud& cloud, const Vector3d& place) {
  std::size_t facing = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    facing += cloud.normals[i].cast<double>().dot(place - cloud.point(i)) > 0 ? 1 : 0;
  }
  return facing;
}

const Sampling kSampling{.spacing = 4e-3};

TEST(FacedPlace, IsBeforeAFloorAndTwoFacesOfABox) {
  // Turned so that no axis is special, and far from the origin.
  const Eigen::Isometry3d stand = Eigen::Translation3d(30, -40, 50) *
                                  Eigen::AngleAxisd(1.1, Vector3d(0.3, -0.5, 0.8).normalized());
  std::vector<TestPoint> points = sheet(kSampling, {-0.1, -0.1}, {0.1, 0.1});
  for (int k = 0; k < 400; ++k) {
    const double along = 1e-3 * (k % 20);
    const double up = 1e-3 * (k / 20);
    points.push_back({{0.02, along, up}, Vector3d::UnitX()});
    points.push_back({{along, 0.02, up}, Vector3d::UnitY()});
  }
  for (TestPoint& p : points) {
    p.position = stand * p.position;
    p.normal = stand.linear() * p.normal;
  }
  const PointCloud cloud = cloud_of(points);
  const auto place = faced_place(cloud);
  ASSERT_TRUE(place);
  EXPECT_GE(count_facing(cloud, *place), cloud.size() * 99 / 100);
}

TEST(FacedPlace, IsNearAWallFarFromTheOriginAndHasFewDigits) {
  std::vector<TestPoint> points = sheet(kSampling, {-0.5, -0.5}, {0.5, 0.5});
  const Vector3d far(448260.3, 5414930.7, 312.4);
  PointCloud cloud = cloud_of(points);
  cloud.origin = far;
  const auto place = faced_place(cloud);
  ASSERT_TRUE(place);
  EXPECT_EQ(count_facing(cloud, *place), cloud.size());
  EXPECT_LT((*place - far).norm(), 10);
  EXPECT_NEAR(10 * place->x(), std::round(10 * place->x()), 1e-6);
}

TEST(FacedPlace, OfASheetIsOnTheSideOfItsNormals) {
  const auto place = faced_place(cloud_of(sheet(kSampling, {-0.04, -0.04}, {0.04, 0.04})));
  ASSERT_TRUE(place);
  EXPECT_GT(place->z(), 0.01);
}

TEST(FacedPlace, IsNoneWhereNormalsFaceApartOrAreMissing) {
  EXPECT_FALSE(faced_place(cloud_of(ball(kSampling, 0.03))));
  std::vector<TestPoint> inward = ball(kSampling, 0.03);
  for (TestPoint& p : inward) p.normal *= -1;
  EXPECT_FALSE(faced_place(cloud_of(inward))) << "a camera has all points on one side";
  std::vector<TestPoint> turned = ball(kSampling, 0.03);
  for (TestPoint& p : turned) {
    p.position.z() += 0.5;
    if (p.normal.dot(p.position) > 0) p.normal *= -1;
  }
  EXPECT_FALSE(faced_place(cloud_of(turned))) << "its near side hides its far one from the origin";
  PointCloud bare = cloud_of(sheet(kSampling, {-0.04, -0.04}, {0.04, 0.04}));
  bare.normals.clear();
  EXPECT_FALSE(faced_place(bare));
  EXPECT_FALSE(faced_place({}));
  EXPECT_FALSE(faced_place(cloud_of(std::vector<TestPoint>(500, {{1, 1, 1}, {0, 0, 1}}))));
}

}  // namespace
}  // namespace palpate::test
