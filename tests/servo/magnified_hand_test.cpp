#include <gtest/gtest.h>

#include <algorithm>

#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// A hand at 4 m/s whose motion is magnified tenfold, over clouds that come ten times a second and
// are clipped to where it can be: it never comes to the end of the newest.
TEST(MagnifiedHand, NeverLeavesWhatWasPreparedForIt) {
  constexpr double kInterval = 0.1;
  constexpr double kScale = 10;
  SourceOptions options;
  options.policy.policy = Policy::average;
  options.policy.history = 1;
  options.policy.clip_to_reach = true;
  Scene scene;
  Source& source = scene.add("sensor", options);
  PointCloud cloud;
  cloud.viewpoint = Vector3d(0, 0, 1);
  for (int i = -20; i <= 1500; ++i) {
    for (int j = -3; j <= 3; ++j) cloud.positions.push_back({0.02F * i, 0.02F * j, 0});
  }
  test::FreeDevice device;
  Servo servo(device, scene, {.workspace = {.scale = kScale}});
  for (int tick = 0; tick <= 500; ++tick) {
    const double now = 1e-3 * tick;
    device.state().position.x() = 4 * now;
    servo.tick(now);
    if (tick % 100 != 0) continue;
    source.push(cloud, now, [=] { return now + 0.01; });
    const auto points = source.points();
    if (tick == 0) {
      EXPECT_LT(points->size(), cloud.size() / 10) << "of a hand at rest";
      continue;
    }
    const auto by_x = [](const auto& a, const auto& b) { return a.x() < b.x(); };
    const double end = points->origin.x() + std::ranges::max(points->grid.points(), by_x).x();
    EXPECT_GT(end, kScale * 4 * (now + kInterval + 0.01)) << now;
  }
}

}  // namespace
}  // namespace palpate
