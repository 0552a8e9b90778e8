// Measures the distance between surfaces whose distance is known.
#include <gtest/gtest.h>

#include "palpate/scene/scene.hpp"
#include "scene/source_inside.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using test::make_points;
using test::plane;
using test::share;
using test::still;

TEST(Disagreement, IsTheDistanceAlongTheNormals) {
  for (const double distance : {0.0, 1e-3, 3e-3, 8e-3}) {
    const auto found = disagreement(make_points(plane(distance)), make_points(plane(0)));
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(*found, distance, 1e-6);
  }
}

TEST(Disagreement, CountsWherePointsAreGoing) {
  SurfacePoints moving = make_points(plane(0));
  for (const auto& p : moving.grid.points()) {
    moving.end_positions.push_back(p + Eigen::Vector3f(0, 0, 2e-3f));
  }
  finish(moving);
  const auto found = disagreement(moving, make_points(plane(0)));
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(*found, 2e-3, 1e-6);
}

TEST(Disagreement, SurfacesThatShareNothingDoNotDisagree) {
  EXPECT_FALSE(disagreement(make_points(plane(1)), make_points(plane(0))).has_value());
  auto back = plane(-2e-3);
  for (auto& point : back) point.normal = -point.normal;
  EXPECT_FALSE(disagreement(make_points(back), make_points(plane(0))).has_value())
      << "the other side of a plate";
  EXPECT_FALSE(disagreement(SurfacePoints(), make_points(plane(0))).has_value());
}

TEST(Disagreement, ASceneTellsTheWorstOfTheOthers) {
  Scene scene;
  scene.add("a").publish(still(plane(0)));
  EXPECT_FALSE(scene.state(0).disagreement.has_value());
  scene.add("b").publish(still(plane(1e-3)));
  scene.add("c").publish(still(plane(-3e-3)));
  EXPECT_NEAR(scene.state(0).disagreement.value_or(0), 3e-3, 1e-6);
  EXPECT_NEAR(scene.state(1).disagreement.value_or(0), 4e-3, 1e-6);
  EXPECT_FALSE(scene.source(0).state().disagreement.has_value());
}

}  // namespace
}  // namespace palpate
