#include "prepare/given_signs.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

/// A sphere of random points whose normals point inward, which nothing but these can tell.
PointCloud inward_sphere() {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  PointCloud cloud;
  for (int i = 0; i < 4000; ++i) {
    const Vector3f out = Vector3f(normal(random), normal(random), normal(random)).normalized();
    cloud.positions.push_back(0.1f * out);
    cloud.normals.push_back(-out);
  }
  return cloud;
}

/// Points whose normals point outward.
int outward(const SurfacePoints& points) {
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    count += points.normals[i].dot(points.grid.points()[i]) > 0 ? 1 : 0;
  }
  return count;
}

TEST(GivenSigns, CountsWhatIsThere) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(share_given({}), 0);
  const std::vector<Vector3f> normals = {{0, 0, 1}, {0, 0, 0}, {nan, 0, 1}, {0, -1e-3f, 0}};
  EXPECT_EQ(share_given(normals), 0.5);
}

TEST(GivenSigns, MissingOnesFollowTheirNeighbours) {
  PointCloud cloud = inward_sphere();
  EXPECT_EQ(outward(prepare(cloud).points), 0);
  for (std::size_t i = 0; i < cloud.size(); i += 2) cloud.normals[i].setZero();
  EXPECT_EQ(outward(prepare(cloud).points), 0);
}

TEST(GivenSigns, CrossWidePatchesRoundByRound) {
  PointCloud cloud = inward_sphere();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.positions[i].z() > 0) cloud.normals[i].setConstant(NAN);
  }
  EXPECT_EQ(outward(prepare(cloud, {.orientation = Orientation::given}).points), 0);
}

TEST(GivenSigns, AreNotAskedWhenMostAreMissing) {
  PointCloud cloud = inward_sphere();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (i % 8 != 0) cloud.normals[i].setZero();
  }
  EXPECT_EQ(outward(prepare(cloud).points), 4000);
  EXPECT_EQ(outward(prepare(cloud, {.orientation = Orientation::given}).points), 0);
  for (Vector3f& n : cloud.normals) n.setZero();
  EXPECT_EQ(outward(prepare(cloud).points), 4000);
  EXPECT_THROW((void)prepare(cloud, {.orientation = Orientation::given}), Error);
}

TEST(GivenSigns, WhatNothingReachesPointsOutward) {
  PointCloud cloud = inward_sphere();
  const std::size_t near = cloud.size();
  for (std::size_t i = 0; i < near; ++i) {
    cloud.positions.push_back(cloud.positions[i] + Vector3f(1, 0, 0));
    cloud.normals.push_back(Vector3f::Zero());
  }
  const SurfacePoints points = prepare(cloud).points;
  int inward = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f& p = points.grid.points()[i];
    const Vector3f center(p.x() > 0.5f ? 1.0f : 0.0f, 0, 0);
    inward += points.normals[i].dot(p - center) < 0 ? 1 : 0;
  }
  EXPECT_EQ(inward, 4000);
}

}  // namespace
}  // namespace palpate
