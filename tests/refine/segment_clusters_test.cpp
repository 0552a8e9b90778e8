// Which sets of segments hang together: those that agree as a whole.
#include "refine/segment_clusters.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "geometry/clouds.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

TEST(SegmentClusters, JoinSetsThatAgreeAsAWhole) {
  // 1 and 2 are opposite. Segment 0 agrees with both alike, 3 agrees with 1 and not with 2.
  const std::vector<SignedEdge> edges{
      {0, 1, {20, 20}}, {0, 2, {20, 20}}, {1, 2, {-30, 30}}, {1, 3, {8, 8}}, {2, 3, {-0.2, 0.2}}};
  SegmentClusters sets(edges, 4);
  EXPECT_EQ(sets.sign_between(0, 1), 1);
  EXPECT_EQ(sets.sign_between(2, 3), 0);  // too few votes
  ASSERT_EQ(sets.sign_between(1, 2), -1);
  sets.join(1, 2, -1);
  EXPECT_EQ(sets.find(2), std::pair(1u, -1));
  EXPECT_EQ(sets.sign_between(0, 1), 0);
  ASSERT_EQ(sets.sign_between(1, 3), 1);
  sets.join(1, 3, 1);
  EXPECT_EQ(sets.find(3), std::pair(1u, 1));
  EXPECT_EQ(sets.sign_between(0, 1), 0);
}

TEST(SegmentClusters, TurnWithTheSetThatTheyAreOf) {
  // The set of 2 and 3 has more to say, but its root becomes 1.
  const std::vector<SignedEdge> edges{
      {0, 2, {9, 9}}, {0, 3, {9, 9}}, {1, 2, {-20, 20}}, {2, 3, {40, 40}}, {3, 4, {7, 7}}};
  SegmentClusters sets(edges, 5);
  sets.join(2, 3, sets.sign_between(2, 3));
  sets.join(1, 2, sets.sign_between(1, 2));
  EXPECT_EQ(sets.find(3), std::pair(1u, -1));
  EXPECT_EQ(sets.sign_between(0, 1), -1);
  EXPECT_EQ(sets.sign_between(4, 1), -1);
  sets.join(0, 1, -1);
  EXPECT_EQ(sets.sign_between(0, 4), 1);
}

/// A box of 10 x 30 x `height` on a floor that goes on beneath it, a point per unit area.
std::vector<Vector3f> box_on_floor(unsigned seed, int height) {
  test::Clouds clouds(seed);
  std::vector<Vector3f> points;
  const auto off = [&] { return clouds.uniform(0.2, 0.8); };
  const auto add = [&](double x, double y, double z) {
    points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
  };
  for (int i = -20; i < 30; ++i) {
    for (int j = -20; j < 50; ++j) add(i + off(), j + off(), 0);
  }
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 30; ++j) add(i + off(), j + off(), height);
    for (int k = 0; k < height; ++k) {
      for (const double y : {0., 30.}) add(i + off(), y, k + off());
    }
  }
  for (int j = 0; j < 30; ++j) {
    for (int k = 0; k < height; ++k) {
      for (const double x : {0., 10.}) add(x, j + off(), k + off());
    }
  }
  return points;
}

TEST(SegmentClusters, LeaveMostBoxesApartFromAFloorThatGoesOnBeneathThem) {
  int apart = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    PointCloud cloud;
    cloud.positions = box_on_floor(seed, 8);
    const SurfacePoints points = prepare(cloud).points;
    const auto component_at = [&](const Vector3f& place) {
      std::vector<CellGrid::Neighbor> nearest;
      points.grid.nearest(place - points.origin.cast<float>(), 1, nearest);
      const std::uint32_t segment = points.segments.segment[nearest.front().index];
      EXPECT_NE(segment, SurfacePoints::Segments::kNone);
      return segment == SurfacePoints::Segments::kNone ? segment
                                                       : points.segments.component[segment];
    };
    const std::uint32_t floor = component_at({-10, 15, 0});
    EXPECT_EQ(component_at({5, 15, 0}), floor) << seed;
    const bool together = component_at({5, 15, 8}) == floor || component_at({0, 15, 4}) == floor ||
                          component_at({5, 30, 4}) == floor;
    apart += together ? 0 : 1;
  }
  EXPECT_GE(apart, 28);  // of 300 seeds 242 are, and 122 where segments are joined one by one
}

}  // namespace
}  // namespace palpate
