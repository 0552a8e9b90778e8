#include <gtest/gtest.h>

#include <random>

#include "palpate/servo/servo_thread.hpp"

namespace palpate {
namespace {

constexpr double kPeriod = 1e-3;  // s

TEST(Deadlines, KeepsTheGridWhateverTheLateness) {
  ServoThread::Deadlines deadlines(5, kPeriod);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> late(0, 0.9e-3);
  for (int i = 0; i < 10'000; ++i) {
    ASSERT_NEAR(deadlines.next(), 5 + i * kPeriod, 1e-9);
    const double lateness = late(random);
    ASSERT_NEAR(deadlines.begin(deadlines.next() + lateness), lateness, 1e-12);
  }
  EXPECT_EQ(deadlines.skipped(), 0u);
}

TEST(Deadlines, LeavesOutWhatAGapMadeImpossible) {
  ServoThread::Deadlines deadlines(0, kPeriod);
  EXPECT_EQ(deadlines.begin(0), 0);
  EXPECT_NEAR(deadlines.begin(0.1004), 0.0994, 1e-12);  // due at 1 ms
  EXPECT_NEAR(deadlines.next(), 0.101, 1e-12) << "the next on the grid: no burst";
  EXPECT_EQ(deadlines.skipped(), 99u);
}

TEST(Deadlines, BeginsEarlyWithoutLateness) {
  ServoThread::Deadlines deadlines(1, kPeriod);
  EXPECT_EQ(deadlines.begin(0.9995), 0);
  EXPECT_NEAR(deadlines.next(), 1.001, 1e-12);
}

TEST(Deadlines, NeverIsDueInThePast) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> late(0, 5e-3);
  for (const double period : {1e-4, 1e-3, 1.0 / 3000, 2e-3}) {
    ServoThread::Deadlines deadlines(1e5, period);
    double now = 1e5;
    double due = 0;
    for (int i = 0; i < 5000; ++i) {
      now = deadlines.next() + late(random);
      deadlines.begin(now);
      ASSERT_GT(deadlines.next(), now);
      ASSERT_LE(deadlines.next(), now + period + 1e-9);
      ASSERT_GT(deadlines.next(), due);
      due = deadlines.next();
    }
  }
}

TEST(Deadlines, FollowsWhatElsePacesTheSteps) {
  ServoThread::Deadlines deadlines(0, kPeriod);
  double now = 0;
  for (int i = 0; i < 1000; ++i) {  // a device whose milliseconds are 2 % long
    deadlines.begin(now);
    deadlines.restart(now);
    now += 1.02e-3;
    ASSERT_NEAR(deadlines.begin(now), 0.02e-3, 1e-9);
    deadlines.restart(now);
  }
  EXPECT_EQ(deadlines.skipped(), 0u);
}

}  // namespace
}  // namespace palpate
