#include "accuracy/truth_frame.hpp"

#include <gtest/gtest.h>

#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {
namespace {

TEST(TruthFrame, SeesTheTableAtSeventyCentimetres) {
  const TruthScene scene = make_truth_scene();
  const DepthFrame frame = exact_frame(scene);
  EXPECT_NEAR(frame.depth[240 * 640 + 320], 0.7, 0.002);
  const PointCloud cloud = back_project(frame);
  ASSERT_EQ(cloud.size(), frame.depth.size());
  for (std::size_t i = 0; i < cloud.size(); i += 997) {
    const Eigen::Vector3d world = scene.camera.T_world_camera * cloud.point(i);
    EXPECT_LT(std::abs(distance_and_normal(scene, world).value), 2e-6);
  }
}

TEST(TruthFrame, TakesOneFrameForOneSeed) {
  const DepthFrame exact = exact_frame(make_truth_scene());
  SimulatedNoiseOptions noise;
  noise.seed = 4;
  const DepthFrame frame = noisy_frame(exact, noise);
  EXPECT_EQ(frame.depth, noisy_frame(exact, noise).depth);
  noise.seed = 5;
  EXPECT_NE(frame.depth, noisy_frame(exact, noise).depth);
}

}  // namespace
}  // namespace palpate::accuracy
