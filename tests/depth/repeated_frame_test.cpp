// Frames that repeat the one before.
#include <gtest/gtest.h>

#include "depth/small_frames.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

const Solid kTable = plane({0, 0, 0.7}, Vector3d(0, -0.5, -0.8).normalized());

DepthFilter averaging() {
  DepthFilterOptions options;
  options.noise = kinect_like_noise();
  options.memory = 8;
  return DepthFilter(options);
}

TEST(RepeatedFrame, IsKnown) {
  DepthFilter filter = averaging();
  DepthFrame frame = noisy_frame({kTable}, {});
  EXPECT_FALSE(filter.filter(frame, Isometry3d::Identity()).duplicate);
  const std::vector<Vector3f> before = filter.filter(frame, Isometry3d::Identity()).positions;
  frame.stamp = 5;
  const FilteredDepth& out = filter.filter(frame, Isometry3d::Identity());
  EXPECT_TRUE(out.duplicate);
  EXPECT_EQ(out.stamp, 5);
  EXPECT_EQ(out.positions, before);
  frame.depth[100] += 1e-6F;
  EXPECT_FALSE(filter.filter(frame, Isometry3d::Identity()).duplicate);
  filter.reset();
  EXPECT_FALSE(filter.filter(frame, Isometry3d::Identity()).duplicate);
}

TEST(RepeatedFrame, IsFittedInNewBalls) {
  DepthFilter filter = averaging();
  const DepthFrame frame = noisy_frame({kTable}, {});
  filter.filter(frame, Isometry3d::Identity(), {});
  const std::vector<Ball> balls = {{{0, 0, 0.7}, 0.03}};
  const FilteredDepth& out = filter.filter(frame, Isometry3d::Identity(), balls);
  EXPECT_TRUE(out.duplicate);
  EXPECT_EQ(out.states[static_cast<std::size_t>(30 * out.columns + 40)],
            FilteredDepth::State::fitted);
}

// The last frame is no second measurement: where it was fitted, it stays as it is.
TEST(RepeatedFrame, IsAveragedOnce) {
  DepthFilter filter = averaging();
  const std::vector<Ball> balls = {{{0, 0, 0.7}, 0.1}};
  for (std::uint64_t k = 0; k < 3; ++k) {
    filter.filter(noisy_frame({kTable}, {.seed = 3}, k), Isometry3d::Identity(), balls);
  }
  const auto index = static_cast<std::size_t>(30 * 80 + 40);
  const DepthFrame last = noisy_frame({kTable}, {.seed = 3}, 2);
  const FilteredDepth before = filter.filter(last, Isometry3d::Identity(), balls);
  ASSERT_EQ(before.states[index], FilteredDepth::State::fitted);
  const std::vector<Ball> larger = {{{0, 0, 0.7}, 0.2}};
  const FilteredDepth again = filter.filter(last, Isometry3d::Identity(), larger);
  const FilteredDepth* const whole = filter.fit_all();
  ASSERT_NE(whole, nullptr);
  EXPECT_EQ(again.positions[index], before.positions[index]);
  EXPECT_EQ(whole->positions[index], before.positions[index]);
  EXPECT_EQ(whole->normals[index], before.normals[index]);
  EXPECT_EQ(before.states[0], FilteredDepth::State::plain);
  EXPECT_EQ(whole->states[0], FilteredDepth::State::fitted);
}

}  // namespace
}  // namespace palpate::test
