#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "realtime/watch.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"

namespace palpate::realtime {
namespace {

using test::kFrame;

using Eigen::Vector3d;

SourceOptions options(Policy policy) {
  SourceOptions options;
  options.T_world_sensor = test::looking_down();
  options.policy.policy = policy;
  return options;
}

// A wall that breathes, with a bar before it that comes and goes, and noise.
std::vector<DepthFrame> frames() {
  std::vector<DepthFrame> frames;
  for (unsigned k = 0; k < 8; ++k) {
    const double z = 0.5 + 1e-3 * (k % 3);
    const auto depth = [=](double x, double y) {
      const bool bar = std::abs(x) < 0.02 && k % 4 < 2;
      const bool hole = std::hypot(x - 0.1, y) < 0.02 && k % 2 == 0;
      return hole ? 0 : bar ? 0.4 : z;
    };
    frames.push_back(test::frame_of(test::small_camera(), 0, depth, 5e-4, k));
  }
  return frames;
}

// Pushes frames while a field looks on; what the last hundred allocated and freed.
Findings push(Policy policy, bool moving) {
  Scene scene;
  Source& source = scene.add("camera", options(policy));
  SceneField field(scene);
  std::vector<DepthFrame> all = frames();
  Findings found;
  for (int k = 0; k < 200; ++k) {
    DepthFrame& frame = all[static_cast<std::size_t>(k) % all.size()];
    frame.stamp = k * kFrame;
    if (moving) {
      frame.T_world_sensor = test::looking_down();
      frame.T_world_sensor->pretranslate(Vector3d(0.02 * std::sin(0.1 * k), 0, 0));
    }
    field.update_from(frame.stamp, Vector3d::Zero(), Vector3d::Zero());
    const double start = frame.stamp;
    const Source::StartTime felt = [start] { return start; };
    Watch watch;
    source.push(frame, felt);
    const Findings once = watch.stop();
    for (std::size_t i = 0; k >= 100 && i < kOffences; ++i) found.counts[i] += once.counts[i];
  }
  EXPECT_EQ(source.state().frames, 200u);
  return found;
}

class Preparation : public testing::TestWithParam<Policy> {};

TEST_P(Preparation, AllocatesNothingOnceItIsWarm) {
  for (const bool moving : {false, true}) {
    const Findings found = push(GetParam(), moving);
    EXPECT_EQ(found.count(Offence::allocate), 0) << (moving ? "moving camera" : "still camera");
    EXPECT_EQ(found.count(Offence::release), 0);
    EXPECT_EQ(found.count(Offence::raise), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Policies, Preparation,
                         testing::Values(Policy::replace, Policy::average, Policy::crossfade,
                                         Policy::morph));

}  // namespace
}  // namespace palpate::realtime
