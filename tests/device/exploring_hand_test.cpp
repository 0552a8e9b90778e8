// What a hand feels that explores by itself: plan, hand, device, field, proxy and guard together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "palpate/device/exploration.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/files.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// The extremes of a whole exploration.
struct Felt {
  double asked = 0;    // N, of the deepest press
  double largest = 0;  // N
  double step = 0;     // N, largest change from one step of 1 ms to the next
  double fastest = 0;  // m/s, of the hand
};

Felt explored(const PointCloud& cloud, std::uint64_t seed, double duration) {
  Scene scene;
  scene.add("cloud", cloud);
  const Placement plan = plan_exploration(scene, {}, {.duration = duration, .seed = seed});
  RemoteTarget nobody;
  TeleoperatedHand guide(nobody, plan.target,
                         {.speed = 2, .force = plan.force, .presses = plan.presses});
  SimulatedDevice device({}, guide);
  Servo servo(device, scene, {.proxy = {.stiffness = plan.stiffness}, .workspace = plan.workspace});
  Felt felt{.asked = plan.depth * plan.stiffness};
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < static_cast<int>(1e3 * duration); ++i) {
    const Vector3d force = servo.tick().force;
    felt.largest = std::max(felt.largest, force.norm());
    felt.step = std::max(felt.step, (force - last).norm());
    felt.fastest = std::max(felt.fastest, device.true_velocity().norm());
    last = force;
  }
  return felt;
}

// Straight to where the trajectory is off the surface, a hand that lost the sheet's edge reached
// 1.6 m/s; these strokes are no faster than 0.2 m/s, ways between them 0.3, and some spring off
// what they pressed.
TEST(ExploringHand, IsAsFastAsItsWaysWhereItLostWhatItPressed) {
  for (const char* name : {"sheet", "table", "bumps"}) {
    const Felt felt = explored(synthetic_cloud(name), 1, 8);
    EXPECT_LT(felt.fastest, 0.5) << name;
    EXPECT_LT(felt.largest, 1.2 * felt.asked) << name;
    EXPECT_LT(felt.step, 0.5) << name;
  }
}

// A hand that went straight to the end of a lost stroke felt 2 to 3.2 times the force of the
// first, and changes of 0.6 to 0.9 N in a step; an edge of the second threw it with 1.2 m/s.
TEST(ExploringHand, RealSurfacesPushNoHarderThanItPresses) {
  const char* data = std::getenv("PALPATE_DATA");
  if (data == nullptr) GTEST_SKIP() << "PALPATE_DATA is not set";
  if (test::is_slow_build()) GTEST_SKIP() << test::kSlowBuild;
  for (const char* name : {"osd_test7.pcd", "capture0001.pcd"}) {
    const std::filesystem::path file = std::filesystem::path(data) / "pcl_tabletop" / name;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
    for (int seed = 1; seed <= std::max(1, test::effort(2)); ++seed) {
      const Felt felt = explored(read_cloud(file), static_cast<std::uint64_t>(seed), 8);
      EXPECT_LT(felt.largest, 1.2 * felt.asked) << name << ", seed " << seed;
      EXPECT_LT(felt.step, 0.5) << name << ", seed " << seed;
      EXPECT_LT(felt.fastest, 0.8) << name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace palpate
