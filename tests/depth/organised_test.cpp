#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palpate/depth/depth_frame.hpp"
#include "support/organised_clouds.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::organised_cloud;
using test::organised_frame;

void expect_camera(const OrganisedFrame& found, const DepthFrame& truth) {
  ASSERT_TRUE(found.frame) << found.why_none;
  const Pinhole& p = found.frame->camera.pinhole;
  const Pinhole& q = truth.camera.pinhole;
  EXPECT_NEAR(p.fx, q.fx, 1e-3);
  EXPECT_NEAR(p.fy, q.fy, 1e-3);
  EXPECT_NEAR(p.cx, q.cx, 1e-3);
  EXPECT_NEAR(p.cy, q.cy, 1e-3);
  EXPECT_EQ(found.frame->camera.width, truth.camera.width);
  EXPECT_EQ(found.frame->camera.height, truth.camera.height);
  EXPECT_LT(found.residual, 1e-3);
}

double largest_difference(const std::vector<float>& one, const std::vector<float>& other) {
  double largest = one.size() == other.size() ? 0 : INFINITY;
  for (std::size_t i = 0; i < one.size() && i < other.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(one[i] - other[i])));
  }
  return largest;
}

TEST(Organised, TheCameraAndItsDepthsComeBack) {
  const DepthFrame truth = organised_frame();
  const auto holes = std::ranges::count(truth.depth, 0.0F);
  ASSERT_GT(holes, 100);
  ASSERT_LT(holes, 160 * 120 / 2);
  const OrganisedFrame found = depth_frame_of(organised_cloud(truth));
  expect_camera(found, truth);
  EXPECT_EQ(found.frame->depth, truth.depth);
  EXPECT_FALSE(found.frame->T_world_sensor) << "the camera's frame is the cloud's";
}

TEST(Organised, ACameraThatStoodElsewhereIsFoundByItsViewpoint) {
  const DepthFrame truth = organised_frame();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Vector3d(1, -2, 0.5));
  T.rotate(Eigen::AngleAxisd(2.2, Vector3d(1, 2, -1).normalized()));
  const OrganisedFrame found = depth_frame_of(organised_cloud(truth, T));
  expect_camera(found, truth);
  ASSERT_TRUE(found.frame->T_world_sensor);
  EXPECT_TRUE(found.frame->T_world_sensor->isApprox(T, 1e-6));
  EXPECT_LT(largest_difference(found.frame->depth, truth.depth), 2e-6);
}

TEST(Organised, PointsInTheSensorsFrameMayHaveTheViewpointOfAnother) {
  const DepthFrame truth = organised_frame();
  PointCloud cloud = organised_cloud(truth);
  cloud.viewpoint = Vector3d(1, -2, 0.5);
  const OrganisedFrame found = depth_frame_of(cloud);
  expect_camera(found, truth);
  EXPECT_EQ(found.frame->depth, truth.depth);
}

// Files whose z goes up, or x forward as a robot has it.
TEST(Organised, OtherAxesAreTakenExactly) {
  const DepthFrame truth = organised_frame();
  Eigen::Matrix3d robot;
  robot << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Matrix3d flipped = Vector3d(1, -1, -1).asDiagonal();
  for (const Eigen::Matrix3d& axes : {robot, flipped}) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = axes;
    const OrganisedFrame found = depth_frame_of(organised_cloud(truth, T));
    expect_camera(found, truth);
    EXPECT_EQ(found.frame->depth, truth.depth);
    EXPECT_EQ(found.frame->T_world_sensor->linear(), axes);
  }
}

TEST(Organised, AFewPointsThatWereMovedAreLeftOut) {
  const DepthFrame truth = organised_frame();
  PointCloud cloud = organised_cloud(truth);
  std::mt19937 random(3);
  std::normal_distribution<float> gauss(0, 0.05F);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 200, ++moved) {
    cloud.positions[i] += Eigen::Vector3f(gauss(random), gauss(random), gauss(random));
  }
  const OrganisedFrame found = depth_frame_of(cloud);
  expect_camera(found, truth);
  std::size_t apart = 0;
  for (std::size_t i = 0; i < truth.depth.size(); ++i) {
    const float z = found.frame->depth[i];
    EXPECT_TRUE(z == truth.depth[i] || z == 0) << i;
    apart += z != truth.depth[i] ? 1 : 0;
  }
  EXPECT_GE(moved, apart);
  EXPECT_GT(apart, moved / 2);
  for (Eigen::Vector3f& p : cloud.positions) p += Eigen::Vector3f(gauss(random), gauss(random), 0);
  EXPECT_FALSE(depth_frame_of(cloud).frame) << "every point was moved";
}

TEST(Organised, ZerosAreWhatWasNotMeasured) {
  const DepthFrame truth = organised_frame();
  PointCloud cloud = organised_cloud(truth);
  for (std::size_t i = 0; i < truth.depth.size(); ++i) {
    if (truth.depth[i] > 0) continue;
    cloud.positions.emplace_back(0, 0, 0);
    cloud.pixels.push_back(static_cast<std::uint32_t>(i));
  }
  const OrganisedFrame found = depth_frame_of(cloud);
  expect_camera(found, truth);
  EXPECT_EQ(found.frame->depth, truth.depth);
}

TEST(Organised, WhatNoPinholeSeesIsNoFrame) {
  const DepthFrame truth = organised_frame();
  PointCloud orthographic = organised_cloud(truth);
  PointCloud turning = orthographic;  // columns are angles
  PointCloud mirrored = orthographic;
  for (std::size_t i = 0; i < orthographic.size(); ++i) {
    const auto u = static_cast<float>(orthographic.pixels[i] % 160);
    const auto v = static_cast<float>(orthographic.pixels[i] / 160);
    const float z = orthographic.positions[i].z();
    orthographic.positions[i] = {0.004F * (u - 80), 0.004F * (v - 60), z};
    turning.positions[i] = {z * std::sin(0.01F * u), 0.01F * (v - 60) * z, z * std::cos(0.01F * u)};
    mirrored.positions[i].x() *= -1;
  }
  for (const PointCloud& cloud : {orthographic, turning, mirrored}) {
    const OrganisedFrame found = depth_frame_of(cloud);
    EXPECT_FALSE(found.frame);
    EXPECT_GT(found.residual, 0.05);
    EXPECT_NE(found.why_none, "");
  }
  Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
  away.translate(Vector3d(0.3, 0, 0));
  PointCloud unknown = organised_cloud(truth, away);
  unknown.viewpoint.reset();
  EXPECT_FALSE(depth_frame_of(unknown).frame) << "nobody says where the camera stood";
}

TEST(Organised, CloudsWithoutRowsOrWithWrongOnesAreNoFrame) {
  const PointCloud whole = organised_cloud(organised_frame());
  PointCloud loose = whole;
  loose.width = loose.height = 0;
  loose.pixels.clear();
  PointCloud shorter = whole;
  shorter.pixels.pop_back();
  PointCloud beyond = whole;
  beyond.pixels.back() = 160 * 120;
  PointCloud row = whole;
  row.width *= row.height;
  row.height = 1;
  PointCloud few;
  few.width = few.height = 2;
  few.pixels = {0, 3};
  few.positions = {{0, 0, 1}, {1, 1, 1}};
  DepthFrame small;
  small.camera = {5, 40, {525, 525, 2, 20}, {}};
  small.depth.assign(5 * 40, 1);
  PointCloud column = whole;
  column.positions.resize(1);
  column.pixels = {7};
  for (const PointCloud& cloud :
       {PointCloud(), loose, shorter, beyond, row, few, column, organised_cloud(small)}) {
    const OrganisedFrame found = depth_frame_of(cloud);
    EXPECT_FALSE(found.frame && found.frame->depth.empty());
    if (cloud.size() > 2) {
      EXPECT_FALSE(found.frame);
    }
  }
}

}  // namespace
}  // namespace palpate
