// A hand whose place is no number for some frames, over points whose memory is used again.
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::kFrame;

constexpr int kFirst = 4;  // frames that come before
const Vector3d kHand(1e-3, 2e-3, 3e-3);
const Vector3d kNowhere = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

/// Pushes a wall of which every frame sees another part, so that points are never as many as
/// before.
bool push_number(int k, bool clouds, Source& source) {
  const double stamp = kFrame * k;
  const Source::StartTime start = [=] { return stamp + 0.01; };
  const double depth = 0.5 - 1e-3 * (k % 3);
  const double end = 0.04 + 0.02 * ((5 * k + 5) % 7);
  if (!clouds) {
    const auto seen = [=](double x, double /*y*/) { return x > -end ? depth : 0; };
    return source.push(test::frame_of(test::small_camera(), stamp, seen), start);
  }
  PointCloud cloud;
  cloud.viewpoint = Vector3d::Zero();
  for (int i = -static_cast<int>(300 * end); i <= 6; ++i) {
    for (int j = -6; j <= 6; ++j) cloud.positions.emplace_back(4e-3 * i, 4e-3 * j, depth);
  }
  return source.push(cloud, stamp, start);
}

/// What a hand feels that goes down onto the surface.
std::vector<Vector3d> forces_of(SceneField& field, double now) {
  Proxy proxy;
  std::vector<Vector3d> forces;
  for (int i = 0; i < 12; ++i) {
    const Vector3d hip = kHand + i * Vector3d(0.1e-3, 0, -0.5e-3);
    field.update(now, hip, proxy);
    forces.push_back(proxy.step(field, hip, 1e-3).force);
  }
  return forces;
}

class HandUnknown : public testing::TestWithParam<std::pair<Policy, bool>> {};

TEST_P(HandUnknown, ForSomeFramesFeelsWhatAHandFeelsThatWasThere) {
  for (int lost = 1; lost <= 9; ++lost) {
    SourceOptions options;
    options.T_world_sensor = test::looking_down();
    options.policy.policy = GetParam().first;
    options.policy.fit_everywhere = true;
    Scene scene;
    Source& source = scene.add("camera", options);
    SceneField there(scene);
    SceneField unknown(scene);
    double now = 0;
    for (int k = 0; k < kFirst + lost; ++k) {
      ASSERT_TRUE(push_number(k, GetParam().second, source));
      for (int tick = 0; tick < 8; ++tick) {
        now = kFrame * k + 0.011 + kFrame / 9 * tick;
        there.update_from(now, kHand, kHand);
        unknown.update_from(now, k < kFirst ? kHand : kNowhere, kHand);
      }
    }
    const std::vector<Vector3d> expected = forces_of(there, now);
    EXPECT_GT(expected.back().z(), 0.5) << lost;
    EXPECT_EQ(forces_of(unknown, now), expected) << lost << " frames";
  }
}

INSTANTIATE_TEST_SUITE_P(OfFrames, HandUnknown,
                         testing::Values(std::pair(Policy::replace, false),
                                         std::pair(Policy::crossfade, false),
                                         std::pair(Policy::morph, false)));
INSTANTIATE_TEST_SUITE_P(OfClouds, HandUnknown, testing::Values(std::pair(Policy::replace, true)));

}  // namespace
}  // namespace palpate
