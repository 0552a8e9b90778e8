#include "sim/simulated_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

SimulatedMotion everything() {
  SimulatedMotion motion;
  motion.velocity = Vector3d(0.1, -0.2, 0.05);
  motion.axis = Vector3d(1, 2, -1).normalized();
  motion.spin = 0.7;
  motion.swing = Vector3d(0.03, 0, 0.02);
  motion.rock = 0.3;
  motion.frequency = 0.8;
  motion.phase = 0.4;
  motion.begin = 0.5;
  motion.end = 2;
  return motion;
}

TEST(SimulatedMotion, StandsStillUnlessTold) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(1, 2, 3);
  pose.linear() = Eigen::AngleAxisd(1, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_TRUE(moved(pose, {}, 17).isApprox(pose, 1e-15));
}

TEST(SimulatedMotion, CountsItsLineFromItsBeginning) {
  SimulatedMotion motion;
  motion.velocity = Vector3d(1, 0, 0);
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  EXPECT_NEAR(moved(pose, motion, -2).translation().x(), -2, 1e-15);
  motion.begin = 1;
  motion.end = 3;
  EXPECT_EQ(moved(pose, motion, 0).translation().x(), 0);
  EXPECT_NEAR(moved(pose, motion, 2).translation().x(), 1, 1e-15);
  EXPECT_NEAR(moved(pose, motion, 9).translation().x(), 2, 1e-15);
}

TEST(SimulatedMotion, VelocityIsItsDerivative) {
  const SimulatedMotion motion = everything();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Vector3d(0.2, 0, 0.1);
  const double h = 1e-6;
  for (const double t : {0.1, 0.9, 1.7, 2.4}) {
    const Eigen::Isometry3d now = moved(pose, motion, t);
    for (const Vector3d& fixed : {Vector3d(0, 0, 0), Vector3d(0.1, -0.2, 0.3)}) {
      const Vector3d slope =
          (moved(pose, motion, t + h) * fixed - moved(pose, motion, t - h) * fixed) / (2 * h);
      EXPECT_LT((velocity(pose, motion, now * fixed, t) - slope).norm(), 1e-8) << t;
    }
  }
}

SimulatedScene floor_and_ball() {
  SimulatedScene scene;
  Solid ball{SolidKind::ball, Eigen::Isometry3d::Identity(), Vector3d::Constant(0.1)};
  ball.T_world_solid.translation().z() = 1;
  scene.solids = {{Solid{}, {}}, {ball, everything()}};
  return scene;
}

TEST(SimulatedScene, DistanceFollowsWhatMoves) {
  const SimulatedScene scene = floor_and_ball();
  const std::vector<Solid> solids = solids_at(scene, 1.2);
  const Vector3d middle = solids[1].T_world_solid.translation();
  const Vector3d x = middle + Vector3d(0, 0.25, 0);
  EXPECT_NEAR(distance_and_normal(scene, x, 1.2).value, 0.15, 1e-12);
  EXPECT_LT((distance_and_normal(scene, x, 1.2).gradient - Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_NEAR(distance_and_normal(scene, {3, 3, 0.2}, 1.2).value, 0.2, 1e-12);
  EXPECT_TRUE(std::isinf(distance_and_normal(SimulatedScene{}, x, 0).value));
}

// The speed of the surface along its normal is how fast the distance falls.
TEST(SimulatedScene, SurfaceVelocityIsWhatTheDistanceLoses) {
  const SimulatedScene scene = floor_and_ball();
  const double h = 1e-6;
  for (const double t : {0.9, 1.3, 2.6}) {
    const Vector3d middle = solids_at(scene, t)[1].T_world_solid.translation();
    const Vector3d x = middle + 0.1 * Vector3d(1, 1, 1).normalized();
    const Distance here = distance_and_normal(scene, x, t);
    const double slope =
        (distance_and_normal(scene, x, t + h).value - distance_and_normal(scene, x, t - h).value) /
        (2 * h);
    EXPECT_NEAR(surface_velocity(scene, x, t).dot(here.gradient), -slope, 1e-7);
  }
  EXPECT_EQ(surface_velocity(scene, {5, 5, 0}, 1).norm(), 0);
}

}  // namespace
}  // namespace palpate
