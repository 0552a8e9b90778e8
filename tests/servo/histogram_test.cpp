#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "servo/servo_inside.hpp"

namespace palpate {
namespace {

TEST(Histogram, KnowsNothingWhenEmpty) {
  const Durations none = Histogram().look();
  EXPECT_EQ(none.count, 0u);
  EXPECT_EQ(none.quantile(0.5), 0);
  EXPECT_EQ(none.mean(), 0);
}

TEST(Histogram, TellsQuantilesToFivePercentAndTheLongestExactly) {
  Histogram histogram;
  for (int i = 1; i <= 10'000; ++i) histogram.add(1e-6 * i);
  const Durations seen = histogram.look();
  EXPECT_EQ(seen.count, 10'000u);
  for (const double p : {0.01, 0.1, 0.5, 0.9, 0.99, 0.999}) {
    EXPECT_NEAR(seen.quantile(p), p * 1e-2, 0.05 * p * 1e-2) << p;
  }
  EXPECT_EQ(seen.longest, 1e-2);
  EXPECT_LE(seen.quantile(1), seen.longest);
  EXPECT_NEAR(seen.mean(), 0.5 * 10'001 * 1e-6, 1e-12);
  Durations alone;
  for (int i = 1; i <= 10'000; ++i) alone.add(1e-6 * i);
  EXPECT_EQ(alone.counts, seen.counts);
  EXPECT_EQ(alone.count, seen.count);
  EXPECT_EQ(alone.longest, seen.longest);
}

TEST(Histogram, TakesAnythingAndLeavesOutWhatIsNoNumber) {
  Histogram histogram;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double odd : {0.0, -1.0, 1e-12, 1e9, infinity, -infinity}) histogram.add(odd);
  histogram.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(histogram.look().count, 6u);
  EXPECT_EQ(histogram.look().counts.front(), 4u);
  EXPECT_EQ(histogram.look().counts.back(), 2u);
}

TEST(Histogram, TellsWhatCameSinceAnEarlierLook) {
  Histogram histogram;
  for (int i = 0; i < 100; ++i) histogram.add(1e-3);
  const Durations earlier = histogram.look();
  for (int i = 0; i < 10; ++i) histogram.add(5e-5);
  const Durations later = histogram.look().since(earlier);
  EXPECT_EQ(later.count, 10u);
  EXPECT_NEAR(later.quantile(0.5), 5e-5, 0.05 * 5e-5);
  EXPECT_NEAR(later.mean(), 5e-5, 1e-12);
}

TEST(Histogram, MayBeLookedAtWhileItGrows) {
  Histogram histogram;
  std::jthread adding([&] {
    for (int i = 0; i < 20'000; ++i) histogram.add(1e-6);
  });
  std::uint64_t before = 0;
  while (before < 20'000) {
    const std::uint64_t count = histogram.look().count;
    ASSERT_GE(count, before);
    before = count;
  }
}

}  // namespace
}  // namespace palpate
