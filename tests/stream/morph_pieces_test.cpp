// Checks that blocks in fours and on several threads give what each gives alone.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "palpate/depth/depth_filter.hpp"
#include "stream/morph.hpp"
#include "support/depth_frames.hpp"
#include "support/rates.hpp"
#include "support/thread_limit.hpp"

namespace palpate {
namespace {

using test::kFrame;

constexpr double kNoise = 0.5e-3;  // m

FilteredDepth filtered(int k, const test::DepthOf& depth_of,
                       const CameraModel& camera = test::small_camera()) {
  const auto seed = static_cast<unsigned>(k + 1);
  DepthFilter filter({.memory = 1});
  return filter.filter(test::frame_of(camera, k * kFrame, depth_of, kNoise, seed),
                       test::looking_down());
}

/// A slope whose blocks are as they are whatever is beside them.
FilteredDepth slope(int k) {
  FilteredDepth depth = filtered(k, [](double x, double) { return 0.5 + 0.3 * x; });
  for (FilteredDepth::State& state : depth.states) state = FilteredDepth::State::plain;
  return depth;
}

using Shown = std::shared_ptr<const SurfacePoints>;

/// What is shown once frames have come early, so that the surface is on its way.
Shown show(const std::vector<FilteredDepth>& frames) {
  Morph morph{{}};
  Shown last;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const MorphInput input{.depth = frames[k], .pinhole = {}, .everywhere = false};
    const FrameTiming moment{frames[k].stamp, 0.7 * static_cast<double>(k) * kFrame, kFrame};
    auto points = std::make_shared<SurfacePoints>();
    morph.look(input);
    morph.fill(input, moment, points);
    last = points;
  }
  check(*last);
  return last;
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <class T>
std::vector<T> without_fourths(const std::vector<T>& column) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (i % 4 != 3) kept.push_back(column[i]);
  }
  return kept;
}

TEST(MorphPieces, FourTogetherGoAsEachAlone) {
  std::vector<FilteredDepth> frames = {slope(0), slope(1), slope(2)};
  const Shown together = show(frames);
  ASSERT_EQ(together->size(), frames[0].size());
  for (FilteredDepth& frame : frames) {  // the last of every four along the curve
    for (std::size_t b = 0; b < frame.size(); ++b) {
      const std::size_t columns = static_cast<std::size_t>(frame.columns);
      if (b % columns % 2 == 1 && b / columns % 2 == 1)
        frame.states[b] = FilteredDepth::State::empty;
    }
  }
  const Shown alone = show(frames);
  EXPECT_TRUE(same(alone->normals, without_fourths(together->normals)));
  EXPECT_TRUE(same(alone->density_weights, without_fourths(together->density_weights)));
  EXPECT_TRUE(same(alone->radii, without_fourths(together->radii)));
  EXPECT_TRUE(same(alone->confidences, without_fourths(together->confidences)));
  EXPECT_TRUE(same(alone->presences, without_fourths(together->presences)));
  EXPECT_TRUE(same(alone->end_positions, without_fourths(together->end_positions)));
  EXPECT_TRUE(same(alone->end_normals, without_fourths(together->end_normals)));
  EXPECT_TRUE(same(alone->end_density_weights, without_fourths(together->end_density_weights)));
  EXPECT_TRUE(same(alone->end_radii, without_fourths(together->end_radii)));
  EXPECT_TRUE(same(alone->end_confidences, without_fourths(together->end_confidences)));
  EXPECT_TRUE(same(alone->end_presences, without_fourths(together->end_presences)));
}

TEST(MorphPieces, WhatAnEmptyBlockHeldBeforeIsNotSeenAgain) {
  std::vector<FilteredDepth> frames = {slope(0), slope(0)};
  frames[1].stamp = kFrame;
  for (FilteredDepth::State& state : frames[1].states)
    state = FilteredDepth::State::empty;  // and nothing else
  const Shown shown = show(frames);
  ASSERT_EQ(shown->size(), frames[0].size());
  EXPECT_TRUE(same(shown->radii, shown->end_radii));
}

TEST(MorphPieces, TheSameOnAnyNumberOfThreads) {
  std::vector<FilteredDepth> frames;
  const CameraModel camera{320, 240, {375, 375, 159.5, 119.5}, {}};  // more than go at a time
  for (int k = 0; k < 6; ++k) {  // a bar comes over a wall with a step and a roof, and leaves it
    const auto depth_of = [k](double x, double y) {
      if (y > 0.04) return 0.48 + 0.6 * std::abs(x);
      return std::abs(y) < 0.02 && k % 3 == 1 ? 0.4 : x < 0 ? 0.5 : 0.52;
    };
    frames.push_back(filtered(k, depth_of, camera));
  }
  std::vector<Shown> shown;
  ASSERT_FALSE(show(frames)->edges.end.empty());
  for (const std::size_t threads : {1u, 2u, 5u}) {
    const ThreadLimit limit(threads);
    shown.push_back(show(frames));
    EXPECT_TRUE(same(shown[0]->end_positions, shown.back()->end_positions)) << threads;
    EXPECT_TRUE(same(shown[0]->density_weights, shown.back()->density_weights)) << threads;
    EXPECT_TRUE(same(shown[0]->presences, shown.back()->presences)) << threads;
    EXPECT_TRUE(same(shown[0]->cell_reach, shown.back()->cell_reach)) << threads;
    EXPECT_TRUE(same(shown[0]->edges.of_point, shown.back()->edges.of_point)) << threads;
    EXPECT_TRUE(same(shown[0]->edges.start, shown.back()->edges.start)) << threads;
    EXPECT_TRUE(same(shown[0]->edges.end, shown.back()->edges.end)) << threads;
  }
}

}  // namespace
}  // namespace palpate
