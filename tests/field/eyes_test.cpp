// What an eye saw holds towards that eye alone (docs/method.md 2.11).
#include "field/eyes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/effort.hpp"
#include "support/point_field.hpp"
#include "support/point_shapes.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

const Sampling kDense{.spacing = 2e-3, .radius = 8e-3};
const Vector3d kUp = Vector3d::UnitZ();

SurfacePoints level_sheet(double height, const std::optional<Vector3d>& eye) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().z() = height;
  SurfacePoints points = make_points(sheet(kDense, {-0.02, -0.02}, {0.02, 0.02}, T));
  if (eye) points.eye.emplace(SurfaceEye{*eye, {}});
  return points;
}

/// The eyes of all points of some layers around the origin.
Eyes eyes_of(const std::vector<ActiveLayer>& layers) {
  Eyes eyes;
  eyes.begin(Vector3d::Zero());
  for (const ActiveLayer& layer : layers) {
    std::vector<std::uint32_t> all(layer.points->size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    eyes.add(layer, all);
  }
  return eyes;
}

bool holds(const Eyes& eyes, const Vector3d& gradient, const std::vector<double>& weights = {1}) {
  return eyes.hold(Vector3d::Zero(), gradient, weights);
}

TEST(Eyes, WhatNobodySawHoldsFromEverySide) {
  const SurfacePoints points = level_sheet(0, {});
  const Eyes eyes = eyes_of({{.points = &points}});
  EXPECT_TRUE(holds(eyes, kUp));
  EXPECT_TRUE(holds(eyes, -kUp));
}

TEST(Eyes, GradientsFaceTheEyeUpToSixDegreesBeyondARightAngle) {
  const SurfacePoints points = level_sheet(0, Vector3d(0, 0, 0.7));
  const Eyes eyes = eyes_of({{.points = &points}});
  for (const double length : {1e-3, 1.0, 50.0}) {
    EXPECT_TRUE(holds(eyes, length * kUp));
    EXPECT_TRUE(holds(eyes, length * Vector3d(1, 0, -0.09)));
    EXPECT_FALSE(holds(eyes, length * Vector3d(1, 0, -0.11)));
    EXPECT_FALSE(holds(eyes, -length * kUp));
  }
}

TEST(Eyes, EachSourceHoldsTowardsItsOwn) {
  const SurfacePoints above = level_sheet(0, Vector3d(0, 0, 0.7));
  const SurfacePoints below = level_sheet(0, Vector3d(0, 0, -0.7));
  const Eyes eyes = eyes_of({{.points = &above, .source = 0}, {.points = &below, .source = 1}});
  EXPECT_TRUE(holds(eyes, kUp, {1, 0}));
  EXPECT_FALSE(holds(eyes, -kUp, {1, 0.05})) << "the other one has no surface here";
  EXPECT_TRUE(holds(eyes, -kUp, {1, 1}));
  EXPECT_FALSE(holds(eyes, kUp, {0, 1}));
}

TEST(Eyes, RememberedPointsHoldTowardsWhereTheyWereSeenFrom) {
  SurfacePoints points = level_sheet(0, Vector3d(0, 0, -0.7));
  points.eye->remembered.assign(points.size(), kUp.cast<float>());
  EXPECT_TRUE(holds(eyes_of({{.points = &points}}), kUp));
  EXPECT_FALSE(holds(eyes_of({{.points = &points}}), -kUp)) << "no point was seen from there";
  points.eye->remembered.resize(points.size() / 2);
  EXPECT_TRUE(holds(eyes_of({{.points = &points}}), -kUp));
}

/// The eyes of points that were each seen from a direction of their own.
Eyes eyes_that_saw_from(const std::vector<Vector3d>& directions, SurfacePoints& points) {
  std::vector<TestPoint> all(directions.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = {.position = Vector3d(1e-4 * static_cast<double>(i), 0, 0), .radius = 8e-3};
  }
  points = make_points(all);
  points.eye.emplace();
  for (const std::uint32_t i : points.grid.order()) {
    points.eye->remembered.push_back(directions[i].normalized().cast<float>());
  }
  return eyes_of({{.points = &points}});
}

Vector3d random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(random), normal(random), normal(random)).normalized();
}

TEST(Eyes, TheOneThatSawTheBackCountsBesideFifteenThatSawTheFront) {
  std::vector<Vector3d> directions;
  for (int i = 0; i < 63; ++i) {
    const double turn = 2.4 * i;  // the golden angle, rad: all around, from the top to the rim
    directions.emplace_back(0.19 * std::sqrt(i) * std::cos(turn),
                            0.19 * std::sqrt(i) * std::sin(turn), 1);
  }
  directions.push_back(-kUp);
  SurfacePoints points;
  const Eyes eyes = eyes_that_saw_from(directions, points);
  EXPECT_TRUE(holds(eyes, kUp));
  EXPECT_TRUE(holds(eyes, -kUp));
}

// From all of space a direction is within 27 degrees of one of 64 (derived: as many caps cover it).
TEST(Eyes, NoDirectionIsDroppedHoweverManyThereAre) {
  std::mt19937 random(4);
  for (int run = 0; run < effort(200); ++run) {
    const bool all_around = run % 2 == 0;
    std::vector<Vector3d> directions;
    const Vector3d towards = random_direction(random);
    while (directions.size() < 600) {
      const Vector3d direction = random_direction(random);
      if (all_around || direction.dot(towards) > 0.3) directions.push_back(direction);
    }
    SurfacePoints points;
    const Eyes eyes = eyes_that_saw_from(directions, points);
    for (int k = 0; k < 50; ++k) {
      const Vector3d gradient = random_direction(random);
      double best = -1;
      for (const Vector3d& direction : directions) best = std::max(best, gradient.dot(direction));
      const bool held = holds(eyes, gradient);
      EXPECT_FALSE(held && best < -0.11) << best;
      EXPECT_TRUE(held || best < (all_around ? 0.7 : 0.25)) << best;
    }
  }
}

TEST(Eyes, ASheetIsSolidToItsBackForNobodyButItsEye) {
  const std::vector<TestPoint> points = sheet(kDense, {-0.04, -0.04}, {0.04, 0.04});
  PointField seen(points, {}, false, Vector3d(0, 0, 0.7));
  PointField plain(points);
  const Vector3d above(0.3e-3, 0.1e-3, 3e-3);
  int behind = 0;
  for (double z = -8e-3; z < 8e-3; z += 0.2e-3) {
    const Vector3d x(0.3e-3, 0.1e-3, z);
    const Sample of_seen = seen.at(above, above).sample(x);
    const Sample of_plain = plain.at(above, above).sample(x);
    const bool away = of_plain.gradient.z() < -0.11 * of_plain.gradient.norm();
    if (of_plain.value > 0 || !away) {
      EXPECT_EQ(of_seen.value, of_plain.value) << z;
      EXPECT_EQ(of_seen.gradient, of_plain.gradient) << z;
      EXPECT_FALSE(of_seen.behind) << z;
      continue;
    }
    ++behind;
    EXPECT_GT(of_seen.value, 0) << z;
    EXPECT_TRUE(of_seen.behind) << z;
    EXPECT_TRUE(of_seen.gradient.isZero(0)) << z;
  }
  EXPECT_GT(behind, 3);
}

}  // namespace
}  // namespace palpate::test
