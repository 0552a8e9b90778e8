// Checks the smoothed interval, the times of snapshots, and how long frames count.
#include "depth/frame_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace palpate {
namespace {

void advance(FrameIntervalFilter& filter, double& stamp, double gap) {
  stamp += gap;
  static_cast<void>(filter.next(stamp, stamp));
}

TEST(FrameIntervalFilter, LearnsTheIntervalFromTwoFrames) {
  FrameIntervalFilter filter;
  EXPECT_NEAR(filter.next(5, 5.01).duration, 1. / 30, 1e-12);
  EXPECT_NEAR(filter.next(5.1, 5.11).duration, 0.1, 1e-12);
}

TEST(FrameIntervalFilter, SmoothsIrregularStamps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.015, 0.015);
  FrameIntervalFilter filter;
  for (int k = 0; k < 300; ++k) {
    const double stamp = k / 30.0 + jitter(random);
    const FrameTiming moment = filter.next(stamp, stamp + 0.01);
    if (k < 20) continue;
    EXPECT_GT(moment.duration, 0.022);
    EXPECT_LT(moment.duration, 0.048);
  }
}

TEST(FrameIntervalFilter, FollowsAnotherRate) {
  FrameIntervalFilter filter;
  double stamp = 0;
  for (int k = 0; k < 30; ++k) advance(filter, stamp, 1. / 90);
  EXPECT_NEAR(filter.interval(), 1. / 90, 1e-6);
  for (int k = 0; k < 60; ++k) advance(filter, stamp, 0.2);
  EXPECT_NEAR(filter.interval(), 0.2, 1e-3);
}

TEST(FrameIntervalFilter, OneLongGapIsNoNewRate) {
  FrameIntervalFilter filter;
  double stamp = 0;
  for (int k = 0; k < 30; ++k) advance(filter, stamp, 1. / 30);
  advance(filter, stamp, 3);
  EXPECT_LT(filter.interval(), 0.038);
}

/// The spare time of frames that the sensor takes every `period`, each prepared for `delay`, s.
double spare_time(double period, double delay) {
  FrameIntervalFilter filter;
  double spare = 0;
  double stamp = 0;
  for (int k = 0; k < 30; ++k) {
    spare = filter.next(stamp, stamp + delay).spare;
    stamp += period * std::ceil(delay / period);
  }
  return spare;
}

TEST(FrameIntervalFilter, FramesThatWaitForPreparationLeaveNoTimeToSpare) {
  EXPECT_NEAR(spare_time(0.5, 0.12), 0.38, 1e-6);
  EXPECT_NEAR(spare_time(0.03, 0.02), 0.01, 1e-6);
  EXPECT_LT(spare_time(0.03, 0.8), 0.03);
  EXPECT_EQ(FrameIntervalFilter().next(3, 9).spare, 0);
}

TEST(FrameIntervalFilter, FramesThatGetQuickerHaveNoMoreTimeToSpareAtOnce) {
  FrameIntervalFilter filter;
  double stamp = 0;
  for (const double delay : {0.8, 0.8, 0.8, 0.8, 0.1, 0.03, 0.03}) {
    EXPECT_LT(filter.next(stamp, stamp + delay).spare, 0.01);
    stamp += delay;
  }
}

TEST(FrameIntervalFilter, StartsNeverGoBack) {
  FrameIntervalFilter filter;
  EXPECT_EQ(filter.next(0, 0.02).start, 0.02);
  EXPECT_EQ(filter.next(0.01, 0.015).start, 0.02);
  EXPECT_EQ(filter.next(0.02, 0.03).start, 0.03);
}

TEST(FrameIntervalFilter, AClockThatIsSetBackChangesNothing) {
  FrameIntervalFilter filter;
  double stamp = 10;
  for (int k = 0; k < 30; ++k) advance(filter, stamp, 1. / 30);
  stamp = 0;
  for (int k = 0; k < 3; ++k) static_cast<void>(filter.next(stamp, 20));
  EXPECT_NEAR(filter.interval(), 1. / 30, 1e-9);
}

constexpr double kInterval = 0.1;     // s
constexpr double kAskedAfter = 0.02;  // s

// The lifetime after frames that are taken up to `jitter` and come up to `lag` (s) early or late,
// and of which a share is lost.
FrameLifetime after(int frames, double jitter, double lost, double lag = 0) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> error(-1, 1);
  std::bernoulli_distribution drop(lost);
  FrameLifetime lifetime;
  std::optional<double> before;
  for (int k = 0; k < frames; ++k) {
    const double stamp = kInterval * k + jitter * error(random);
    const double delay = kAskedAfter + lag * error(random);
    if (drop(random)) continue;
    if (before) lifetime.add(stamp - *before, delay);
    before = stamp;
  }
  return lifetime;
}

TEST(FrameLifetime, IsUnknownAtFirst) {
  EXPECT_FALSE(after(8, 0, 0).longest());
  EXPECT_NEAR(after(9, 0, 0).longest().value(), kInterval + kAskedAfter, 1e-9);
}

TEST(FrameLifetime, IsNoLongerWhereFramesAreLost) {
  EXPECT_NEAR(after(200, 0, 0.4).longest().value(), kInterval + kAskedAfter, 1e-9);
}

TEST(FrameLifetime, IsNearlyAsLongAsAFrameCanLastAndNoLonger) {
  constexpr double kJitter = 0.01;  // s
  constexpr double kLag = 0.005;    // s
  for (const double lost : {0., 0.1, 0.4}) {
    for (int frames = 100; frames < 300; ++frames) {
      const double longest = after(frames, kJitter, lost, kLag).longest().value();
      EXPECT_GT(longest, kInterval + kAskedAfter + kJitter) << lost;
      EXPECT_LT(longest, kInterval + kAskedAfter + 2.2 * kJitter + kLag) << lost;
    }
  }
}

TEST(FrameLifetime, IsNoLongerThanAGapThatLostAFrameAfterTwoCameAtOnce) {
  FrameLifetime lifetime;
  for (int k = 0; k < 16; ++k) lifetime.add(k == 8 ? 0.01 * kInterval : kInterval, kAskedAfter);
  EXPECT_LE(lifetime.longest().value(), FrameLifetime::kLost * kInterval + kAskedAfter + 1e-9);
}

TEST(FrameLifetime, FollowsAnotherRate) {
  FrameLifetime lifetime;
  for (int k = 0; k < 30; ++k) lifetime.add(1. / 60, 0);
  EXPECT_NEAR(lifetime.longest().value(), 1. / 60, 1e-9);
  for (int k = 0; k < 16; ++k) lifetime.add(0.2, 0);
  EXPECT_NEAR(lifetime.longest().value(), 0.2, 1e-9);
}

TEST(FrameLifetime, IsNegativeWhereTheCamerasClockIsAhead) {
  FrameLifetime lifetime;
  for (int k = 0; k < 16; ++k) lifetime.add(0.1, -0.3);
  EXPECT_NEAR(lifetime.longest().value(), -0.2, 1e-9);
  EXPECT_NEAR(lifetime.interval().value(), 0.1, 1e-9);
}

}  // namespace
}  // namespace palpate
