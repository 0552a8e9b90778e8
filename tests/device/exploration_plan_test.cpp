#include <gtest/gtest.h>

#include "device/explore.hpp"
#include "field/formulas.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/io/synthetic.hpp"

namespace palpate {
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
    const Placement plan = plan_exploration(scene, {}, {.duration = 2});
    EXPECT_NEAR(plan.workspace.felt_stiffness(plan.stiffness), 500, 1e-6) << factor;
    EXPECT_LE(plan.depth * plan.stiffness, 4 + 1e-9) << factor;
    double reach = 0;
    for (const TrajectoryRow& row : plan.target) reach = std::max(reach, row.position.norm());
    EXPECT_LT(reach, 0.5) << factor;
    EXPECT_GT(reach, 0.01) << factor;
  }
}

TEST(ExplorationPlan, PressesAreWhereTheTargetIsUnderTheSurface) {
  Scene scene;
  scene.add("cloud", scaled(1));
  const Placement plan = plan_exploration(scene, {}, {.duration = 10});
  ASSERT_GT(plan.presses.size(), 3u);
  double last = 0;
  for (const Press& press : plan.presses) {
    EXPECT_LE(last, press.begin);
    EXPECT_LE(press.begin, press.end);
    EXPECT_LE(press.end, press.resume);
    EXPECT_GT(press.pull, 0);
    EXPECT_LT(press.pull, plan.depth) << "in a scene of scale 1";
    last = press.resume;
  }
}

TEST(ExplorationPlan, StiffnessThatWasAskedForIsKeptAndHeldStable) {
  Scene scene;
  scene.add("cloud", scaled(1000));
  const Placement plan = plan_exploration(scene, {}, {.duration = 1, .stiffness = 500});
  EXPECT_EQ(plan.stiffness, 500);
  EXPECT_LE(plan.workspace.felt_stiffness(plan.stiffness), 2000);
}

TEST(ExplorationPlan, RefusesOptionsOutOfRange) {
  Scene scene;
  scene.add("cloud", scaled(1));
  EXPECT_THROW((void)place_device(scene, {}, {.scale = 0}), Error);
  EXPECT_THROW((void)place_device(scene, {}, {.stiffness = -1}), Error);
  EXPECT_THROW((void)place_device(scene, {}, {.tool_radius = -1e-3}), Error);
  EXPECT_THROW((void)plan_exploration(scene, {}, {.rate = 0}), Error);
  EXPECT_THROW((void)plan_exploration(scene, {}, {.hand = {.stiffness = 0}}), Error);
}

TEST(ExplorationPlan, ADeviceThatNobodyLeadsStandsJustOutsideTheMiddleOfTheSurface) {
  for (const double factor : {1.0, 1000.0}) {
    PointCloud plane;
    for (int i = -40; i <= 40; ++i) {
      for (int j = -40; j <= 40; ++j) {
        const Eigen::Vector3f place(2e-3f * static_cast<float>(i), 2e-3f * static_cast<float>(j),
                                    0);
        plane.positions.push_back(static_cast<float>(factor) * place);
      }
    }
    plane.viewpoint = Eigen::Vector3d(0, 0, factor);
    Scene scene;
    scene.add("plane", plane);
    const ExplorationOptions options{.duration = 1};
    const Placement placement = place_device(scene, {}, options);
    const Placement plan = plan_exploration(scene, {}, options);
    EXPECT_EQ(placement.workspace.scale, plan.workspace.scale) << "as hands that explore";
    EXPECT_EQ(placement.stiffness, plan.stiffness);
    const Eigen::Vector3d outside(0, 0, 2e-3 * placement.workspace.scale);
    const Eigen::Vector3d origin = placement.workspace.position_to_world(Eigen::Vector3d::Zero());
    EXPECT_LT((origin - outside).norm(), 1e-6 * factor) << origin.transpose();
  }
}

TEST(ExplorationPlan, ADeviceThatNobodyLeadsComesDownOnWhatIsRound) {
  Scene scene;
  const PointCloud sphere = synthetic_cloud("sphere");
  scene.add("sphere", sphere);
  float top = 0;
  for (const Eigen::Vector3f& p : sphere.positions) top = std::max(top, p.z());
  const Placement placement = place_device(scene, {}, {.duration = 1});
  const Eigen::Vector3d origin = placement.workspace.position_to_world(Eigen::Vector3d::Zero());
  EXPECT_NEAR(origin.z(), static_cast<double>(top) + 2e-3, 1e-3);
  EXPECT_LT(origin.head<2>().norm(), 5e-3) << origin.transpose();
}

// The hand's wish is offset - depth under the highest place: what it means to feel follows the
// metaball's level.
TEST(ExplorationPlan, HandStopsHigherOverASurfaceThatLiesHigher) {
  PointCloud plane;
  for (int i = 0; i < 100 * 100; ++i) {
    plane.positions.emplace_back(2e-3f * static_cast<float>(i % 100),
                                 2e-3f * static_cast<float>(i / 100), 0.f);
  }
  plane.viewpoint = Eigen::Vector3d(0.1, 0.1, 1);
  Scene scene;
  scene.add("plane", plane);
  const double radius = scene.source(0).report().radius;
  const auto lowest = [&](const FieldOptions& field) {
    const Placement plan = plan_exploration(scene, field, {.duration = 2});
    double z = 1;
    for (const TrajectoryRow& row : plan.target) {
      z = std::min(z, plan.workspace.position_to_world(row.position).z());
    }
    return z;
  };
  FieldOptions field{.kind = FieldOptions::Kind::metaball, .threshold = 0.4};
  const double usual = lowest(field);
  field.threshold = 0.05;
  EXPECT_NEAR(lowest(field) - usual,
              radius * (plane_offset(Kernel::wyvill, 0.05) - plane_offset(Kernel::wyvill, 0.4)),
              1e-4);
  field.kernel = Kernel::wendland;
  EXPECT_NEAR(lowest(field) - usual,
              radius * (plane_offset(Kernel::wendland, 0.05) - plane_offset(Kernel::wyvill, 0.4)),
              1e-4);
}

TEST(ExplorationPlan, SceneWithoutPointsIsRefused) {
  Scene scene;
  scene.add("camera");
  EXPECT_THROW((void)plan_exploration(scene, {}, {}), Error);
}

}  // namespace
}  // namespace palpate
