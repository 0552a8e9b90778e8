#include <gtest/gtest.h>

#include <random>

#include "palpate/device/device.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

Workspace turned_and_magnified() {
  Workspace workspace;
  workspace.T_world_device =
      Eigen::Translation3d(10, 20, 30) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  workspace.scale = 5;
  return workspace;
}

TEST(Workspace, DefaultLeavesEveryBitAlone) {
  const Workspace workspace;
  const Vector3d p(0.1, -0.2, 1e-17);
  EXPECT_EQ(workspace.position_to_world(p), p);
  EXPECT_EQ(workspace.position_to_device(p), p);
  EXPECT_EQ(workspace.force_to_device(p), p);
}

TEST(Workspace, PositionsGoThereAndBack) {
  const Workspace workspace = turned_and_magnified();
  const Vector3d p(0.01, -0.02, 0.03);
  EXPECT_LT((workspace.position_to_device(workspace.position_to_world(p)) - p).norm(), 1e-14);
}

TEST(Workspace, VelocityIsThePositionsDerivative) {
  const Workspace workspace = turned_and_magnified();
  const Vector3d p(0.01, -0.02, 0.03);
  const Vector3d v(0.3, 0.1, -0.2);
  const double dt = 1e-3;
  const Vector3d moved = workspace.position_to_world(p + dt * v) - workspace.position_to_world(p);
  EXPECT_LT((moved / dt - workspace.velocity_to_world(v)).norm(), 1e-9);
}

TEST(Workspace, OrientationTurnsAsPlacesDo) {
  const Workspace workspace = turned_and_magnified();
  const Eigen::Quaterniond held(Eigen::AngleAxisd(0.4, Vector3d(0, 1, 1).normalized()));
  const Vector3d tip = held * Vector3d::UnitY();
  const Vector3d in_world = workspace.orientation_to_world(held) * Vector3d::UnitY();
  EXPECT_LT((in_world - workspace.velocity_to_world(tip) / workspace.scale).norm(), 1e-14);
  EXPECT_EQ(Workspace().orientation_to_world(held).coeffs(), held.coeffs());
}

TEST(Workspace, ForceKeepsItsLengthAndWorkIsDividedByScale) {
  const Workspace workspace = turned_and_magnified();
  const Vector3d force(1, -2, 0.5);
  const Vector3d motion(1e-3, 2e-3, -3e-3);
  const Vector3d at_hand = workspace.force_to_device(force);
  EXPECT_NEAR(at_hand.norm(), force.norm(), 1e-14);
  EXPECT_NEAR(at_hand.dot(motion), force.dot(workspace.velocity_to_world(motion)) / workspace.scale,
              1e-15);
}

TEST(Workspace, FeltStiffnessIsForceAtTheHandForItsOwnMetres) {
  const Workspace workspace = turned_and_magnified();
  const double stiffness = 100;
  const Vector3d a(0.01, 0, 0);
  const Vector3d b(0.012, 0.001, 0);
  const Vector3d in_world =
      stiffness * (workspace.position_to_world(b) - workspace.position_to_world(a));
  EXPECT_NEAR(workspace.force_to_device(in_world).norm(),
              workspace.felt_stiffness(stiffness) * (b - a).norm(), 1e-12);
}

}  // namespace

}  // namespace palpate
