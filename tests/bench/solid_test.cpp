#include "accuracy/solid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "accuracy/depth_camera.hpp"
#include "accuracy/normal_generator.hpp"
#include "accuracy/truth_scene.hpp"
#include "palpate/base/error.hpp"

namespace palpate::accuracy {
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
  const TruthScene scene = make_truth_scene();
  NormalGenerator random(7);
  const double h = 1e-6;
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d x(0.3 * random.normal(), 0.3 * random.normal(), 0.1 * random.normal());
    for (const Solid& solid : scene.solids) {
      const Distance found = distance_and_normal(solid, x);
      if (found.value < 1e-3) continue;  // edges seen from inside have no gradient
      Vector3d slope;
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Vector3d step = h * Vector3d::Unit(axis);
        slope[axis] = (distance(solid, x + step) - distance(solid, x - step)) / (2 * h);
      }
      EXPECT_LT((slope - found.normal).norm(), 1e-5);
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(TruthScene, HasClearObjectsInEveryLayout) {
  for (int layout = 0; layout < kLayouts; ++layout) {
    const TruthScene scene = make_truth_scene(layout);
    for (std::size_t i = kSphere; i < kParts; ++i) {
      const Vector3d middle = scene.solids[i].T_world_solid.translation();
      for (std::size_t k = kWall; k < kParts; ++k) {
        if (k == i) continue;
        EXPECT_GT(distance(scene.solids[k], middle), 0.06) << layout << i << k;
      }
      EXPECT_GT(distance(scene.solids[i], scene.slide_center), 0.09) << layout << i;
    }
  }
  EXPECT_THROW((void)make_truth_scene(kLayouts), Error);
}

TEST(DepthCamera, SeesTheTableAtSeventyCentimetres) {
  const TruthScene scene = make_truth_scene();
  const DepthImage image = render_depth(scene);
  EXPECT_NEAR(image.at(320, 240), 0.7, 0.002);
  const PointCloud cloud = back_project(image, scene.camera.pinhole);
  ASSERT_EQ(cloud.size(), image.depth.size());
  for (std::size_t i = 0; i < cloud.size(); i += 997) {
    const Vector3d world = scene.camera.T_world_camera * cloud.point(i);
    EXPECT_LT(std::abs(distance_and_normal(scene, world).value), 2e-6);
  }
}

}  // namespace
}  // namespace palpate::accuracy
