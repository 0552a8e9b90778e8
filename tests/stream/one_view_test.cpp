// Which clouds have an eye (docs/method.md 2.11).
#include "stream/one_view.hpp"

#include <gtest/gtest.h>

#include "support/point_shapes.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const Sampling kSampling{.spacing = 4e-3};

PointCloud cloud_of(const std::vector<TestPoint>& points, const Vector3d& viewpoint) {
  PointCloud cloud;
  cloud.viewpoint = viewpoint;
  for (const TestPoint& p : points) {
    cloud.positions.push_back(p.position.cast<float>());
    cloud.normals.push_back(p.normal.cast<float>());
  }
  return cloud;
}

TEST(OneView, GivenNormalsThatFaceTheViewpointProveIt) {
  const Vector3d eye(0, 0, 0.5);
  const PointCloud cloud = cloud_of(sheet(kSampling, {-0.04, -0.04}, {0.04, 0.04}), eye);
  Eigen::Isometry3d stand = Eigen::Isometry3d::Identity();
  stand.translate(Vector3d(1, 2, 3));
  const auto found = OneView{}.eye_of(cloud, {}, stand);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->position, Vector3d(1, 2, 3.5));
}

TEST(OneView, AClosedBodyBesideItsViewpointHasNoEye) {
  const PointCloud cloud = cloud_of(ball(kSampling, 0.03), {0, 0, 0.5});
  EXPECT_FALSE(OneView{}.eye_of(cloud, {}, Eigen::Isometry3d::Identity()));
}

TEST(OneView, LoosePointsWithoutNormalsProveNothing) {
  PointCloud cloud = cloud_of(sheet(kSampling, {-0.04, -0.04}, {0.04, 0.04}), {0, 0, 0.5});
  cloud.normals.clear();
  EXPECT_FALSE(OneView{}.eye_of(cloud, {}, Eigen::Isometry3d::Identity()));
  const auto asked =
      OneView{}.eye_of(cloud, {.viewpoint = Vector3d(0, 0, 2)}, Eigen::Isometry3d::Identity());
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->position, Vector3d(0, 0, 2));
}

}  // namespace
}  // namespace palpate::test
