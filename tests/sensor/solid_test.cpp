#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "palpate/base/error.hpp"
#include "sim/simulated_depth.hpp"
#include "sim/simulated_scene.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

const Solid kBlock{SolidKind::block, Eigen::Isometry3d::Identity(), Vector3d(1, 2, 3)};
const Solid kUpright{SolidKind::cylinder, Eigen::Isometry3d::Identity(), Vector3d(1, 1, 2)};

TEST(Solid, KnowsDistancesInsideAndOutside) {
  EXPECT_DOUBLE_EQ(distance(kBlock, {0, 0, 0}), -1);
  EXPECT_DOUBLE_EQ(distance(kBlock, {1.5, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(distance(kBlock, {4, 6, 0}), 5);
  EXPECT_DOUBLE_EQ(distance(kUpright, {0, 0, 1.5}), -0.5);
  EXPECT_DOUBLE_EQ(distance(kUpright, {4, 0, 6}), 5);
  const Solid ball{SolidKind::ball, Eigen::Isometry3d::Identity(), Vector3d::Constant(2)};
  EXPECT_DOUBLE_EQ(distance(ball, {0, 3, 4}), 3);
  EXPECT_DOUBLE_EQ(distance(ball, {0, 0, 0}), -2);
}

TEST(Solid, NormalIsTheDistancesGradient) {
  const std::vector<Solid> solids = solids_at(make_simulated_table().scene, 0);
  Random random(7);
  const double h = 1e-6;
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d x(0.3 * random.normal(), 0.3 * random.normal(), 0.1 * random.normal());
    for (const Solid& solid : solids) {
      const Distance found = distance_and_normal(solid, x);
      if (found.value < 1e-3) continue;  // edges seen from inside have no gradient
      Vector3d slope;
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Vector3d step = h * Vector3d::Unit(axis);
        slope[axis] = (distance(solid, x + step) - distance(solid, x - step)) / (2 * h);
      }
      EXPECT_LT((slope - found.gradient).norm(), 1e-5);
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(SimulatedTable, HasClearObjectsInEveryLayout) {
  for (int layout = 0; layout < kTableLayouts; ++layout) {
    const SimulatedTable table = make_simulated_table(layout);
    const std::vector<Solid> solids = solids_at(table.scene, 0);
    for (std::size_t i = kSphere; i < kTableParts; ++i) {
      const Vector3d middle = solids[i].T_world_solid.translation();
      for (std::size_t k = kWall; k < kTableParts; ++k) {
        if (k == i) continue;
        EXPECT_GT(distance(solids[k], middle), 0.06) << layout << i << k;
      }
      EXPECT_GT(distance(solids[i], table.free_patch), 0.09) << layout << i;
    }
  }
  EXPECT_THROW((void)make_simulated_table(kTableLayouts), Error);
}

}  // namespace
}  // namespace palpate
