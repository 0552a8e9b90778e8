// What the bench on real recordings takes for flat.
#include "accuracy/flat_patch.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "accuracy/truth_frame.hpp"
#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {
namespace {

constexpr int kU = 320;
constexpr int kV = 240;

DepthFrame frame_of(const Solid& solid) {
  TruthScene scene = make_empty_scene();
  scene.solids[0] = solid;
  SimulatedNoiseOptions noise;
  noise.kind = NoiseKind::independent;
  return noisy_frame(exact_frame(scene), noise);
}

// A metre away, turned by 30 degrees about x.
Solid leaning_plane() {
  Solid solid;
  solid.T_world_solid = Eigen::Translation3d(0, 0, 1) *
                        Eigen::AngleAxisd(5 * std::numbers::pi / 6, Eigen::Vector3d::UnitX());
  return solid;
}

TEST(FlatPatch, FindsThePlaneThatIsThere) {
  const Solid plane = leaning_plane();
  const auto patch = flat_patch(frame_of(plane), kU, kV);
  ASSERT_TRUE(patch);
  const Eigen::Vector3d normal = plane.T_world_solid.linear().col(2);
  EXPECT_GT(patch->normal.dot(normal), 0.99999);
  EXPECT_NEAR(distance(plane, patch->center), 0, 2e-4);
}

TEST(FlatPatch, TakesNoBall) {
  Solid ball;
  ball.kind = SolidKind::ball;
  ball.size = Eigen::Vector3d::Constant(0.4);
  ball.T_world_solid.translation() = Eigen::Vector3d(0, 0, 1.4);
  EXPECT_FALSE(flat_patch(frame_of(ball), kU, kV));
}

TEST(FlatPatch, TakesNoEdgeOfTwoPlanes) {
  Solid box;
  box.kind = SolidKind::block;
  box.size = Eigen::Vector3d::Constant(0.3);
  box.T_world_solid = Eigen::Translation3d(0, 0, 1.4) *
                      Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitY());
  EXPECT_FALSE(flat_patch(frame_of(box), kU, kV));
}

}  // namespace
}  // namespace palpate::accuracy
