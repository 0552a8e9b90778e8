#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "device/explore.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

ExploredSurface view(const PointCloud& cloud) {
  return {cloud.origin, cloud.positions, cloud.normals};
}

TEST(Exploration, LastsAsLongAsItIsToldAndMovesAtHandSpeeds) {
  const PointCloud cloud = synthetic_cloud("torus");
  const Trajectory rows =
      explore(view(cloud), {.duration = 3, .radius = 5e-3, .depth = 3e-3, .region = 1});
  EXPECT_NO_THROW(check(rows));
  EXPECT_NEAR(rows.back().time, 3, 2e-3);
  double fastest = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    fastest = std::max(fastest, (rows[i].position - rows[i - 1].position).norm() / 1e-3);
  }
  EXPECT_LT(fastest, 0.3);
  EXPECT_GT(fastest, 0.05);
}

TEST(Exploration, PressesIntoASphereToTheDepthWantedAndNotDeeper) {
  const PointCloud cloud = synthetic_cloud("sphere");
  const double depth = 2e-3;
  const Trajectory rows =
      explore(view(cloud), {.duration = 6, .radius = 5e-3, .depth = depth, .region = 1});
  double deepest = 1;
  int touching = 0;
  for (const TrajectoryRow& row : rows) {
    const double height = row.position.norm() - 0.06;
    deepest = std::min(deepest, height);
    touching += height < 0 ? 1 : 0;
  }
  EXPECT_NEAR(deepest, -depth, 3e-4);
  const double share = static_cast<double>(touching) / static_cast<double>(rows.size());
  EXPECT_GT(share, 0.3);
  EXPECT_LT(share, 0.9);
}

TEST(Exploration, AToolIsHeldAsFarOffAsItReachesAgainstTheSurface) {
  const PointCloud cloud = synthetic_cloud("sphere");
  const double depth = 2e-3;
  // A box that is 20 mm high and 10 mm wide: a corner is farthest against most normals.
  std::vector<Ball> box;
  for (int i = 0; i < 8; ++i) {
    box.push_back({{5e-3 - 1e-2 * (i & 1), 5e-3 - 1e-2 * (i >> 1 & 1), 10e-3 - 2e-2 * (i >> 2)}});
  }
  const auto reach = [](const Vector3d& n) {
    return 5e-3 * std::abs(n.x()) + 5e-3 * std::abs(n.y()) + 10e-3 * std::abs(n.z());
  };
  const StrokeOptions options{
      .duration = 6, .radius = 5e-3, .depth = depth, .region = 1, .tool = box};
  double deepest = 1;
  for (const TrajectoryRow& row : explore(view(cloud), options)) {
    const double height = row.position.norm() - 0.06;
    deepest = std::min(deepest, height - reach(row.position.normalized()));
  }
  EXPECT_NEAR(deepest, -depth, 4e-4);
}

TEST(Exploration, SlidesOverAGoodPartOfTheObject) {
  const PointCloud cloud = synthetic_cloud("bumps");
  const Trajectory rows =
      explore(view(cloud), {.duration = 10, .radius = 5e-3, .depth = 3e-3, .region = 1});
  int visited = 0;
  constexpr int kTiles = 5;  // 4 cm each
  for (int i = 0; i < kTiles * kTiles; ++i) {
    const Vector3d corner(-0.1 + 0.04 * (i % kTiles), -0.1 + 0.04 * (i / kTiles), 0);
    visited += std::any_of(rows.begin(), rows.end(), [&](const TrajectoryRow& row) {
      const Vector3d d = row.position - corner;
      return d.z() < 5e-3 && d.x() > 0 && d.x() < 0.04 && d.y() > 0 && d.y() < 0.04;
    });
  }
  EXPECT_GE(visited, 10);
}

TEST(Exploration, GoesRoundAClosedObjectAndNotThroughIt) {
  const PointCloud cloud = synthetic_cloud("sphere");
  const Trajectory rows =
      explore(view(cloud), {.duration = 10, .radius = 5e-3, .depth = 2e-3, .region = 1});
  ASSERT_FALSE(rows.empty());
  for (const TrajectoryRow& row : rows) EXPECT_GT(row.position.norm(), 0.055);
}

// A floor of 30 x 20 cm and a box on it, 6 cm long, 8 cm high and as wide as the floor. What looks
// from above sees no walls.
PointCloud box_on_floor(bool walls) {
  PointCloud cloud;
  const auto add = [&cloud](double x, double y, double z, const Vector3f& normal) {
    cloud.positions.push_back(Vector3d(x, y, z).cast<float>());
    cloud.normals.push_back(normal);
  };
  for (double y = -0.1; y <= 0.1; y += 2e-3) {
    for (double x = -0.15; x <= 0.15; x += 2e-3) {
      add(x, y, std::abs(x) <= 0.03 ? 0.08 : 0, Vector3f::UnitZ());
    }
    for (double z = 2e-3; walls && z < 0.079; z += 2e-3) {
      add(-0.03, y, z, -Vector3f::UnitX());
      add(0.03, y, z, Vector3f::UnitX());
    }
  }
  return cloud;
}

TEST(Exploration, LiftsOverWhatStandsBetweenTwoPlaces) {
  for (const bool walls : {false, true}) {
    const PointCloud cloud = box_on_floor(walls);
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Trajectory rows = explore(
          view(cloud), {.duration = 40, .radius = 5e-3, .depth = 3e-3, .region = 1, .seed = seed});
      int within = 0;
      int crossings = 0;
      for (std::size_t i = 1; i < rows.size(); ++i) {
        const Vector3d& at = rows[i].position;
        const bool beside = std::abs(at.x()) > 0.025 || std::abs(at.y()) > 0.1;
        within += !beside && at.z() < 0.075 ? 1 : 0;
        crossings += at.x() * rows[i - 1].position.x() < 0 ? 1 : 0;
      }
      EXPECT_EQ(within, 0) << "walls " << walls << ", seed " << seed;
      EXPECT_GT(crossings, 0) << "walls " << walls << ", seed " << seed;
    }
  }
}

TEST(Exploration, SameSeedSameRowsOtherSeedOtherRows) {
  const PointCloud cloud = synthetic_cloud("table");
  const auto last = [&](std::uint64_t seed) {
    return explore(view(cloud), {.duration = 2, .seed = seed}).back().position;
  };
  EXPECT_EQ(last(1), last(1));
  EXPECT_NE(last(1), last(2));
}

TEST(Exploration, SaysHowFarItIs) {
  const PointCloud cloud = synthetic_cloud("sphere");
  std::vector<double> told;
  const StrokeOptions options{
      .duration = 10, .radius = 5e-3, .region = 1, .progress = [&](double done) {
        told.push_back(done);
      }};
  (void)explore(view(cloud), options);
  EXPECT_GT(told.size(), 3u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GE(told.front(), 0);
  EXPECT_LE(told.back(), 1);
  EXPECT_GT(told.back(), 0.5);
}

TEST(Exploration, WorksWithoutNormals) {
  PointCloud cloud = synthetic_cloud("sphere");
  cloud.normals.clear();
  const Trajectory rows =
      explore(view(cloud), {.duration = 4, .radius = 5e-3, .depth = 2e-3, .region = 1});
  const auto touches = [](const TrajectoryRow& row) { return row.position.norm() < 0.06; };
  EXPECT_GT(std::count_if(rows.begin(), rows.end(), touches), 500);
}

TEST(Exploration, StaysInARegionOfALargeCloudFarFromTheOrigin) {
  PointCloud cloud = synthetic_cloud("bumps");
  for (Vector3f& p : cloud.positions) p *= 500;  // 100 m
  cloud.origin = {637000, 851000, 500};
  const StrokeOptions options{.duration = 5,
                              .radius = 2.5,
                              .depth = 1,
                              .region = 30,
                              .slide_speed = 20,
                              .travel_speed = 50};
  const Trajectory rows = explore(view(cloud), options);
  EXPECT_NO_THROW(check(rows));
  for (const TrajectoryRow& row : rows) {
    const Vector3d d = row.position - cloud.origin;
    EXPECT_LT(d.head<2>().norm(), 40);
  }
}

TEST(Exploration, OneOrTwoPointsAreEnough) {
  const std::vector<Vector3f> points = {{0, 0, 0}};
  const std::vector<Vector3f> zero = {{0, 0, 0}};
  for (const auto& normals : {std::vector<Vector3f>{}, zero}) {
    const Trajectory rows = explore({Vector3d::Zero(), points, normals}, {.duration = 2});
    EXPECT_NO_THROW(check(rows));
    EXPECT_NEAR(rows.back().time, 2, 2e-3);
  }
}

TEST(Exploration, RefusesWhatMakesNoSense) {
  const std::vector<Vector3f> points = {{0, 0, 0}};
  EXPECT_THROW((void)explore({}), Error);
  EXPECT_THROW((void)explore({Vector3d::Zero(), points, {}}, {.duration = -1}), Error);
  EXPECT_THROW((void)explore({Vector3d::Zero(), points, {}}, {.radius = 0}), Error);
}

}  // namespace
}  // namespace palpate
