#include "scene/policies/fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"
#include "support/rates.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using test::kFrame;

using Eigen::Vector3d;

// A sheet at z = 0 with noise, seen from above.
PointCloud noisy_sheet(unsigned seed, double noise, double height = 0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss(0, 1);
  PointCloud cloud;
  cloud.viewpoint = Vector3d(0, 0, 0.5);
  for (int i = -25; i <= 25; ++i) {
    for (int j = -25; j <= 25; ++j) {
      const Vector3d p(2e-3 * i + 2e-4 * gauss(random), 2e-3 * j + 2e-4 * gauss(random),
                       height + noise * gauss(random));
      cloud.positions.push_back(p.cast<float>());
    }
  }
  return cloud;
}

SourceOptions options() {
  SourceOptions options;
  options.policy.policy = Policy::fusion;
  return options;
}

TEST(Fusion, AveragesNoiseAwayAndNeverSteps) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  Scene scene;
  Source& source = scene.add("sensor", options());
  SceneField field(scene);
  double last = 0;
  double step = 0;
  double largest = 0;
  for (int k = 0; k < 20; ++k) {
    const double stamp = k * kFrame;
    source.push(noisy_sheet(static_cast<unsigned>(k), 1e-3), stamp, [=] { return stamp; });
    for (double u = 0.02; u < 1; u += 0.07) {
      field.update(stamp + u * kFrame, Vector3d::Zero(), Vector3d::Zero());
      const double height = test::height_of(field);
      if (k > 10) {
        step = std::max(step, std::abs(height - last));
        largest = std::max(largest, std::abs(height));
      }
      last = height;
    }
  }
  EXPECT_LT(largest, 0.15e-3);
  EXPECT_LT(step, 0.02e-3) << "a fourteenth of what eight clouds can move it in a frame";
}

TEST(Fusion, IsOneSidedAsLongAsItsSensorStandsStill) {
  Fusion fusion({});
  const auto one_sided_from = [&](double t, double x) {
    Eigen::Isometry3d T_world_sensor = Eigen::Isometry3d::Identity();
    T_world_sensor.translation().x() = x;
    fusion.add(noisy_sheet(1, 1e-4), T_world_sensor, true);
    return fusion.surface({t, t, kFrame}).one_sided;
  };
  EXPECT_TRUE(one_sided_from(0, 0));
  EXPECT_TRUE(one_sided_from(kFrame, 1e-5));
  PointCloud nothing;
  nothing.viewpoint = Vector3d(0, 0, 0.5);
  fusion.add(nothing, Eigen::Isometry3d::Identity(), true);
  EXPECT_TRUE(fusion.surface({kFrame, kFrame, kFrame}).one_sided) << "after a frame of nothing";
  EXPECT_FALSE(one_sided_from(2 * kFrame, 0.05)) << "normals may point away from where it was";
  EXPECT_FALSE(one_sided_from(3 * kFrame, 0)) << "what it saw meanwhile is still there";
}

TEST(Fusion, WhatIsNoLongerSeenFadesAway) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  Fusion fusion({});
  const auto add = [&](int k, double height) {
    const double t = k * kFrame;
    fusion.add(noisy_sheet(static_cast<unsigned>(k), 1e-4, height), Eigen::Isometry3d::Identity());
    return fusion.surface({t, t, kFrame});
  };
  for (int k = 0; k < 10; ++k) add(k, 0);
  SurfacePoints points = add(10, 0.1);
  const std::size_t both = points.size();
  for (int k = 11; k < 60; ++k) points = add(k, 0.1);
  check(points);
  EXPECT_LT(points.size(), 3 * both / 4);
  for (const auto& p : points.grid.points()) EXPECT_GT(p.z() + points.origin.z(), 0.05);
}

TEST(Fusion, BadPointsDoNoHarm) {
  Fusion fusion({});
  fusion.add(noisy_sheet(0, 1e-4), Eigen::Isometry3d::Identity());
  const std::size_t good = fusion.surface({0, 0, kFrame}).size();
  PointCloud bad = noisy_sheet(1, 1e-4);
  bad.positions[7] = {NAN, 0, 0};
  bad.positions[8] = {0, INFINITY, 0};
  bad.positions[9] = {0, 0, 1e30f};
  for (int k = 1; k < 4; ++k) {
    fusion.add(bad, Eigen::Isometry3d::Identity());
    const SurfacePoints points = fusion.surface({k * kFrame, k * kFrame, kFrame});
    check(points);
    EXPECT_LT(points.size(), 3 * good / 2);
  }
}

TEST(Fusion, GoesOnFromWhereTheSurfaceIs) {
  Fusion fusion({});
  const auto add = [&](int k, double start) {
    fusion.add(noisy_sheet(static_cast<unsigned>(k), 5e-4), Eigen::Isometry3d::Identity());
    return fusion.surface({start, start, kFrame});
  };
  for (int k = 0; k < 3; ++k) add(k, k * kFrame);
  const SurfacePoints before = add(3, 3 * kFrame);
  const SurfacePoints after = add(4, 4 * kFrame);
  // Every end of before is a start of after.
  std::vector<CellGrid::Neighbor> near;
  for (std::size_t i = 0; i < before.size(); i += 5) {
    if (before.end_density_weights[i] == 0) continue;
    after.grid.nearest(before.end_positions[i], 1, near);
    ASSERT_FALSE(near.empty());
    EXPECT_EQ(near.front().squared_distance, 0);
    const std::size_t k = near.front().index;
    EXPECT_EQ(after.density_weights[k], before.end_density_weights[i]);
    EXPECT_EQ(after.radii[k], before.end_radii[i]);
  }
}

// A table and a wall behind it, whose points in the crease preparation puts on both.
TEST(Fusion, KeepsThePointsOfACreaseWhereTheyAre) {
  PointCloud crease;
  crease.viewpoint = Vector3d(-0.3, 0, 0.4);
  for (int i = 0; i <= 25; ++i) {
    for (int j = -25; j <= 25; ++j) {
      const float along = 2e-3f * static_cast<float>(i);
      const float across = 2e-3f * static_cast<float>(j);
      crease.positions.emplace_back(-along, across, 0.f);
      if (i > 0) crease.positions.emplace_back(0.f, across, along);
    }
  }
  PrepareOptions prepare;
  prepare.voxel = 4e-3;
  Fusion fusion(prepare);
  SurfacePoints points;
  for (int k = 0; k < 3; ++k) {
    fusion.add(crease, Eigen::Isometry3d::Identity());
    points = fusion.surface({k * kFrame, k * kFrame, kFrame});
  }
  check(points);
  EXPECT_EQ(points.size(), fusion.report().points_out);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = points.end_positions[i];
    EXPECT_LT((p - points.grid.points()[i]).norm(), 1e-6f) << "the same cloud again";
    const bool lies = std::abs(p.z()) < 2e-3f;
    EXPECT_TRUE(lies || std::abs(p.x()) < 2e-3f) << p.transpose();
    if (std::abs(p.x()) + std::abs(p.z()) < 8e-3f) continue;
    EXPECT_GT(lies ? points.end_normals[i].z() : -points.end_normals[i].x(), 0.9f);
  }
}

}  // namespace
}  // namespace palpate
