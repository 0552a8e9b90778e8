#include "apps/palpate/exploration_plan.hpp"

#include <gtest/gtest.h>

#include "apps/palpate/touch_surface.hpp"
#include "palpate/base/error.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate::app {
namespace {

PointCloud scaled(double factor) {
  PointCloud cloud = synthetic_cloud("bumps");
  for (Eigen::Vector3f& p : cloud.positions) p *= static_cast<float>(factor);
  cloud.viewpoint.reset();
  return cloud;
}

TEST(ExplorationPlan, ScaleIsOneForWhatAHandCanReachAndRoundOtherwise) {
  for (const double extent : {0.07, 0.15, 0.6, 1.2}) EXPECT_EQ(workspace_scale(extent), 1);
  EXPECT_DOUBLE_EQ(workspace_scale(100), 500);
  EXPECT_DOUBLE_EQ(workspace_scale(0.003), 0.01);
  EXPECT_DOUBLE_EQ(workspace_scale(0.02), 0.1);
}

TEST(ExplorationPlan, HandFeelsTheSameOfSmallAndLargeClouds) {
  for (const double factor : {0.01, 1.0, 1000.0}) {
    Scene scene;
    scene.add("cloud", scaled(factor));
    const ExplorationPlan plan = plan_exploration(scene, {}, {.duration = 2});
    EXPECT_NEAR(plan.workspace.felt_stiffness(plan.stiffness), kStiffness, 1e-6) << factor;
    EXPECT_LE(plan.depth * plan.stiffness, 4 + 1e-9) << factor;
    double reach = 0;
    for (const TrajectoryRow& row : plan.target) reach = std::max(reach, row.position.norm());
    EXPECT_LT(reach, 0.5) << factor;
    EXPECT_GT(reach, 0.01) << factor;
  }
}

TEST(ExplorationPlan, StiffnessThatWasAskedForIsKeptAndHeldStable) {
  Scene scene;
  scene.add("cloud", scaled(1000));
  const ExplorationPlan plan = plan_exploration(scene, {}, {.duration = 1, .stiffness = 500});
  EXPECT_EQ(plan.stiffness, 500);
  EXPECT_LE(plan.workspace.felt_stiffness(plan.stiffness), 2000);
}

TEST(ExplorationPlan, SceneWithoutPointsIsRefused) {
  Scene scene;
  scene.add("camera");
  EXPECT_THROW((void)plan_exploration(scene, {}, {}), Error);
}

}  // namespace
}  // namespace palpate::app
