#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/base/error.hpp"
#include "sim/simulated_camera.hpp"
#include "sim/simulated_scene.hpp"

// Keys of what sensors do besides noise, and the scenes that show it.

namespace palpate {
namespace {

std::vector<float> frame_of(const std::string& specification) {
  DepthFrame frame;
  EXPECT_EQ(open_simulated(specification, nullptr)->read(frame, 0), DepthCamera::Status::frame);
  return frame.depth;
}

// The depths of the upper quarter of `approach`, which is wall at 0.9 m.
double deviation(const std::string& keys) {
  const std::vector<float> depth = frame_of("approach,silhouettes=0," + keys);
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < depth.size() / 4; ++i) {
    if (depth[i] <= 0) continue;
    squares += (depth[i] - 0.9) * (depth[i] - 0.9);
    ++count;
  }
  return std::sqrt(squares / count);
}

TEST(SimulatedKeys, ChangeWhatIsSeen) {
  const std::string plain = "approach,width=160,seed=2";
  for (const char* key :
       {"sigma=0.004", "terraces=0.125", "curl=0.004", "mixed=0.5", "pattern=0.002", "holes=0.05",
        "correlation=8", "smoothing=2", "noise=tof", "noise=stereo", "noise=structured"}) {
    EXPECT_NE(frame_of(plain), frame_of(plain + "," + key)) << key;
  }
  EXPECT_EQ(frame_of(plain), frame_of(plain + ",terraces=0,curl=0,mixed=0,pattern=0,holes=0"));
}

TEST(SimulatedKeys, SayWhichValuesMakeNoSense) {
  for (const char* wrong :
       {"sigma=-0.001", "sigma=0.2", "terraces=-1", "terraces=9", "curl=0.2", "mixed=3",
        "pattern=-1", "correlation=40", "smoothing=16", "hops=0.2", "holes=1", "repeat=1",
        "repeat=-1", "jump=-1", "tilt=91", "noise=laser", "width=4", "width=5000", "width=20.5"}) {
    EXPECT_THROW((void)open_simulated(std::string("table,") + wrong, nullptr), Error) << wrong;
  }
}

TEST(SimulatedKeys, SetTheDeviationOfNoise) {
  for (const double sigma : {0.001, 0.004, 0.015}) {
    EXPECT_NEAR(deviation("sigma=" + std::to_string(sigma)), sigma, 0.06 * sigma);
  }
  // 1.5 - 0.5 z + 0.3 z^2 and a pattern of 1, mm; 0.08 pixels of disparity and a step of 1/32.
  EXPECT_NEAR(deviation("noise=tof"), std::hypot(1.293e-3, 1e-3), 0.1e-3);
  EXPECT_NEAR(deviation("noise=stereo"), 1.65e-3, 0.2e-3);
  EXPECT_NEAR(deviation("noise=structured"), 1.9e-3, 0.4e-3);
  EXPECT_EQ(frame_of("still,seed=4,noise=tof"), frame_of("still,noise=tof,seed=4"));
}

TEST(SimulatedScenes, PolesStandBeforeAWall) {
  const SimulatedSetup setup = make_simulated_setup("poles");
  const Eigen::Vector3d eye = setup.camera.T_world_camera.translation();
  EXPECT_TRUE(eye.isApprox(Eigen::Vector3d(-1, 0, 0), 1e-9));
  EXPECT_TRUE(setup.camera.T_world_camera.linear().col(2).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
  const std::vector<float> depth = frame_of("poles,noise=none,silhouettes=0");
  std::vector<int> widths;
  for (int u = 0; u < 640; ++u) {
    const bool pole = depth[240 * 640 + static_cast<std::size_t>(u)] < 1.1f;
    const bool before = u > 0 && depth[240 * 640 + static_cast<std::size_t>(u) - 1] < 1.1f;
    if (pole && !before) widths.push_back(0);
    if (pole) ++widths.back();
  }
  ASSERT_EQ(widths.size(), 4u);
  for (int k = 0; const double thickness : {0.008, 0.015, 0.025, 0.040}) {
    EXPECT_NEAR(widths[static_cast<std::size_t>(k++)], thickness * 525,
                1.5 + 0.1 * thickness * 525);
  }
}

TEST(SimulatedScenes, ATiltSaysHowTheTableIsSeen) {
  for (const auto& [scene, degrees] : {std::pair{"slant", 65},
                                       {"slant,tilt=30", 30},
                                       {"slant,view=40,tilt=80", 80},
                                       {"still", 63},
                                       {"still,tilt=0", 0}}) {
    const auto camera = open_simulated(scene, nullptr);
    const Eigen::Isometry3d pose = camera->true_pose(0);
    const Eigen::Vector3d forward = pose.linear().col(2);
    EXPECT_NEAR(std::acos(std::min(1.0, -forward.z())) * 180 / std::numbers::pi, degrees, 1e-5);
    EXPECT_TRUE((pose.translation() + 0.7 * forward).isZero(1e-9)) << scene;
    EXPECT_NEAR(pose.linear()(2, 0), 0, 1e-9) << "upright";
  }
}

TEST(SimulatedScenes, AnArmSweepsOverTheTable) {
  const SimulatedScene scene = make_simulated_setup("arm").scene;
  const std::size_t arm = scene.solids.size() - 1;
  double fastest = 0;
  double leftmost = 0;
  double rightmost = 0;
  for (double t = 0; t < 20; t += 0.01) {
    const Solid solid = solids_at(scene, t)[arm];
    const double y = solid.T_world_solid.translation().y();
    const Eigen::Vector3d under(0, y, 0);
    EXPECT_NEAR(distance(solid, under), 0.13, 1e-9);
    fastest = std::max(fastest, std::abs(velocity(scene.solids[arm].solid.T_world_solid,
                                                  scene.solids[arm].motion, under, t)
                                             .y()));
    leftmost = std::min(leftmost, y);
    rightmost = std::max(rightmost, y);
    // It touches nothing that stands there.
    EXPECT_GT(distance(scene.solids[kSphere].solid, {0.02, y, 0.17}), 0.04);
    EXPECT_GT(distance(scene.solids[kCylinder].solid, {0.24, y, 0.17}), 0.04);
  }
  EXPECT_NEAR(fastest, 0.3, 1e-3);
  EXPECT_NEAR(rightmost - leftmost, 0.318, 1e-3);
  EXPECT_TRUE(solids_at(scene, 3)[arm].T_world_solid.isApprox(
      solids_at(scene, 23)[arm].T_world_solid, 1e-9))
      << "cameras see one world again after 20 s";
}

}  // namespace
}  // namespace palpate
