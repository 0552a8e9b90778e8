// Which points make one segment, how segments vote on each other, which points lie on two of them.
#include "refine/segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "geometry/clouds.hpp"
#include "palpate/prepare/prepare.hpp"
#include "refine/fitted.hpp"
#include "refine/second_planes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;
using test::Fitted;
using test::floor_and_wall;

std::vector<Vector3f> plane(int side, const Vector3f& from = Vector3f::Zero()) {
  std::vector<Vector3f> points = test::Clouds().plane(side, 1);
  for (Vector3f& p : points) p += from;
  return points;
}

std::vector<Vector3f> both(std::vector<Vector3f> points, const std::vector<Vector3f>& others) {
  points.insert(points.end(), others.begin(), others.end());
  return points;
}

TEST(SegmentGrowing, OfAFloorAndAWallMakesTwoSegments) {
  Fitted fitted(floor_and_wall(15));
  const GrownSegments grown = grow_segments(fitted.input(), fitted.own);
  ASSERT_EQ(grown.segments.component.size(), 2u);
  for (std::size_t i = 0; i < fitted.grid.size(); ++i) {
    const Vector3f& p = fitted.grid.points()[i];
    if (p.x() < 1.5f && p.z() < 1.5f) continue;  // beside the crease: on either
    const bool wall = p.x() == 0;
    EXPECT_GT(std::abs(wall ? fitted.own.normals[i].x() : fitted.own.normals[i].z()), 0.99f);
  }
}

/// A flat ring, seven points wide, that turns over within `twist` of its `length` points.
std::vector<Vector3f> band_with_half_twist(int length, int twist) {
  constexpr double kPi = std::numbers::pi;
  const double radius = length / (2 * kPi);
  std::vector<Vector3f> points;
  for (int k = 0; k < length; ++k) {
    const double around = 2 * kPi * k / length;
    const double over = k < twist ? kPi * k / twist : kPi;
    for (int u = -3; u <= 3; ++u) {
      const double out = radius + u * std::cos(over);
      const double x = out * std::cos(around);
      const double y = out * std::sin(around);
      points.push_back(Eigen::Vector3d(x, y, u * std::sin(over)).cast<float>());
    }
  }
  return points;
}

// No signs agree all around such a band, wherever the borders of blocks are.
TEST(SegmentGrowing, LetsSignsPartWhereASegmentTurnsTheMost) {
  constexpr int kLength = 400;
  constexpr int kTwist = 20;
  for (int turn = 0; turn < 8; ++turn) {
    const Eigen::AngleAxisf rotation(0.7f * static_cast<float>(turn), Vector3f::UnitZ());
    PointCloud cloud;
    for (const Vector3f& p : band_with_half_twist(kLength, kTwist)) {
      cloud.positions.push_back(rotation * p);
    }
    const SurfacePoints points = prepare(cloud, {.voxel = 0.0}).points;
    int up = 0;
    int all = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3f p = rotation.inverse() * points.grid.points()[i];
      const double place = kLength * std::atan2(p.y(), p.x()) / (2 * std::numbers::pi);
      if (place > -3 && place < kTwist + 3) continue;
      ++all;
      if (points.normals[i].z() > 0) ++up;
    }
    EXPECT_GT(all, 2600);
    EXPECT_TRUE(up == 0 || up == all) << up << " of " << all << ", turn " << turn;
  }
}

TEST(SegmentGrowing, OfASphereMakesOneSegmentWhoseNormalsAgree) {
  Fitted fitted(test::Clouds(2).sphere(3000, 15));
  const GrownSegments grown = grow_segments(fitted.input(), fitted.own);
  ASSERT_EQ(grown.segments.component.size(), 1u);
  const float sign = fitted.own.normals[0].dot(fitted.grid.points()[0]) < 0 ? -1.f : 1.f;
  for (std::size_t i = 0; i < fitted.grid.size(); ++i) {
    EXPECT_GT(sign * fitted.own.normals[i].dot(fitted.grid.points()[i].normalized()), 0.9f);
  }
}

TEST(SegmentGrowing, LeavesASegmentOfFewPointsATenthOfItsConfidence) {
  std::vector<Vector3f> few = {{50, 0, 0}};
  for (int k = 0; k < 6; ++k) {
    const float angle = static_cast<float>(k) * std::numbers::pi_v<float> / 3;
    few.emplace_back(50 + std::cos(angle), std::sin(angle), 0);
  }
  Fitted fitted(both(plane(12), few));
  const std::vector<float> before = fitted.own.confidences;
  const GrownSegments grown = grow_segments(fitted.input(), fitted.own);
  EXPECT_EQ(grown.segments.component.size(), 2u);
  for (std::size_t i = 0; i < fitted.grid.size(); ++i) {
    const float share = fitted.grid.points()[i].x() > 40 ? 0.1f : 1.f;
    EXPECT_FLOAT_EQ(fitted.own.confidences[i], share * before[i]);
  }
}

TEST(Votes, KeepNormalsThatLeaveAnEdgeOnOneSideAndTurnOthers) {
  for (const float turned : {1.f, -1.f}) {
    Fitted fitted(floor_and_wall(15));
    GrownSegments grown = grow_segments(fitted.input(), fitted.own);
    for (std::size_t i = 0; i < fitted.grid.size(); ++i) {
      Vector3f& n = fitted.own.normals[i];
      const bool wall = std::abs(n.x()) > 0.9f;
      n = wall ? Vector3f(turned, 0, 0) : Vector3f::UnitZ();
    }
    const std::vector<SignedEdge> votes = look_around(fitted.input(), fitted.own, {}, grown);
    ASSERT_FALSE(votes.empty());
    EdgeWeight all;
    for (const SignedEdge& vote : votes) {
      EXPECT_EQ(vote.a + vote.b, 1u);
      all += vote.weight;
    }
    EXPECT_GT(turned * all.sum, 0.9 * all.size);
  }
}

TEST(Votes, AreNotHeardAcrossMoreThanR) {
  Fitted fitted(both(plane(12), plane(12, {0, 0, 3.5f})));
  GrownSegments grown = grow_segments(fitted.input(), fitted.own);
  EXPECT_EQ(grown.segments.component.size(), 2u);
  EXPECT_TRUE(look_around(fitted.input(), fitted.own, {}, grown).empty());
}

TEST(LookAround, TellsWhatAnotherSegmentHides) {
  Fitted fitted(both(plane(12), plane(12, {0, 0, 2})));
  GrownSegments grown = grow_segments(fitted.input(), fitted.own);
  for (const float z : {-20.f, 20.f}) {
    (void)look_around(fitted.input(), fitted.own, Vector3f(6, 6, z), grown);
    for (std::size_t i = 0; i < fitted.grid.size(); ++i) {
      const bool below = fitted.grid.points()[i].z() < 1;
      EXPECT_EQ(grown.hidden[i] != 0, below == (z > 0)) << i << ", from " << z;
    }
  }
}

TEST(SecondPlanes, AreThePointsOfACreaseAndOfNothingElse) {
  Fitted fitted(floor_and_wall(15));
  const GrownSegments grown = grow_segments(fitted.input(), fitted.own);
  EXPECT_GE(grown.second_planes.size(), 15u);
  for (const SecondPlane& second : grown.second_planes) {
    const Vector3f& p = fitted.grid.points()[second.point];
    EXPECT_EQ(p.x(), 0);
    EXPECT_EQ(p.z(), 0);
    EXPECT_NE(grown.segments.segment[second.point], grown.segments.segment[second.owner]);
  }
  Fitted flat(plane(12));
  EXPECT_TRUE(grow_segments(flat.input(), flat.own).second_planes.empty());
}

TEST(SecondPlanes, ShareTheWeightAndTakeThePlaneOfTheSecondSegment) {
  SurfacePoints points;
  points.grid = CellGrid(std::vector<Vector3f>{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  points.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  points.density_weights = {1, 1, 1};
  points.radii = points.confidences = {1, 1, 1};
  points.segments.segment = {0, 0, 0};
  std::uint32_t corner = 0;
  std::uint32_t owner = 0;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (points.grid.points()[i].isZero()) corner = i;
    if (points.grid.points()[i].z() > 0) owner = i;
  }
  points.normals[owner] = {1, 0, 0};
  points.segments.segment[owner] = 1;
  const std::vector<SecondPlane> second_planes = {{corner, owner}};
  add_second_planes(second_planes, points);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(std::accumulate(points.density_weights.begin(), points.density_weights.end(), 0.f), 3);
  Vector3f sum = Vector3f::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    if (!points.grid.points()[i].isZero()) continue;
    EXPECT_EQ(points.density_weights[i], 0.5f);
    EXPECT_EQ(points.segments.segment[i], points.normals[i].x() > 0 ? 1u : 0u);
    sum += points.normals[i];
  }
  EXPECT_EQ(sum, Vector3f(1, 0, 1));
}

}  // namespace
}  // namespace palpate
