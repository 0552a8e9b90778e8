#include <gtest/gtest.h>

#include <random>

#include "scene/frame_timing.hpp"

namespace palpate {
namespace {

void advance(Rhythm& rhythm, double& stamp, double gap) {
  stamp += gap;
  static_cast<void>(rhythm.next(stamp, stamp));
}

TEST(Rhythm, LearnsTheIntervalFromTwoFrames) {
  Rhythm rhythm;
  EXPECT_NEAR(rhythm.next(5, 5.01).duration, 1. / 30, 1e-12);
  EXPECT_NEAR(rhythm.next(5.1, 5.11).duration, 0.1, 1e-12);
}

TEST(Rhythm, SmoothsIrregularStamps) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.015, 0.015);
  Rhythm rhythm;
  for (int k = 0; k < 300; ++k) {
    const double stamp = k / 30.0 + jitter(random);
    const Moment moment = rhythm.next(stamp, stamp + 0.01);
    if (k < 20) continue;
    EXPECT_GT(moment.duration, 0.022);
    EXPECT_LT(moment.duration, 0.048);
  }
}

TEST(Rhythm, FollowsAnotherRate) {
  Rhythm rhythm;
  double stamp = 0;
  for (int k = 0; k < 30; ++k) advance(rhythm, stamp, 1. / 90);
  EXPECT_NEAR(rhythm.interval(), 1. / 90, 1e-6);
  for (int k = 0; k < 60; ++k) advance(rhythm, stamp, 0.2);
  EXPECT_NEAR(rhythm.interval(), 0.2, 1e-3);
}

TEST(Rhythm, OneLongGapIsNoNewRate) {
  Rhythm rhythm;
  double stamp = 0;
  for (int k = 0; k < 30; ++k) advance(rhythm, stamp, 1. / 30);
  advance(rhythm, stamp, 3);
  EXPECT_LT(rhythm.interval(), 0.038);
}

TEST(Rhythm, StartsNeverGoBack) {
  Rhythm rhythm;
  EXPECT_EQ(rhythm.next(0, 0.02).start, 0.02);
  EXPECT_EQ(rhythm.next(0.01, 0.015).start, 0.02);
  EXPECT_EQ(rhythm.next(0.02, 0.03).start, 0.03);
}

TEST(Rhythm, AClockThatIsSetBackChangesNothing) {
  Rhythm rhythm;
  double stamp = 10;
  for (int k = 0; k < 30; ++k) advance(rhythm, stamp, 1. / 30);
  stamp = 0;
  for (int k = 0; k < 3; ++k) static_cast<void>(rhythm.next(stamp, 20));
  EXPECT_NEAR(rhythm.interval(), 1. / 30, 1e-9);
}

}  // namespace
}  // namespace palpate
