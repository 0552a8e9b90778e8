#include "servo_cost/rises.hpp"

#include <gtest/gtest.h>

namespace palpate::servo_cost {
namespace {

// A hundred and one steps whose p50 and p99 are as told.
ServoRun run_of(double p50, double p99, std::int64_t lock_waits = 0) {
  ServoRun run;
  run.computing.assign(98, p50);
  run.computing.resize(101, p99);
  run.lock_waits = lock_waits;
  return run;
}

TEST(Rises, QuantilesAreOfValuesInOrder) {
  EXPECT_EQ(quantile({}, 0.5), 0);
  EXPECT_EQ(quantile({1, 2, 3, 4, 5}, 0), 1);
  EXPECT_EQ(quantile({1, 2, 3, 4, 5}, 0.5), 3);
  EXPECT_EQ(quantile({1, 2, 3, 4, 5}, 1), 5);
  EXPECT_EQ(median({5, 1, 3}), 3);
}

TEST(Rises, AreMediansOfRatios) {
  Rises rises;
  rises.add(run_of(1.1, 3.0), run_of(1, 2));   // +10 %, +50 %
  rises.add(run_of(1.05, 2.2), run_of(1, 2));  // +5 %, +10 %
  rises.add(run_of(9, 2.0), run_of(1, 2));     // a busy moment
  EXPECT_EQ(rises.pairs(), 3u);
  EXPECT_NEAR(rises.p50(), 0.1, 1e-12);
  EXPECT_NEAR(rises.p99(), 0.1, 1e-12);
}

TEST(Rises, OneWaitForALockIsTooMany) {
  Rises rises;
  rises.add(run_of(1, 2), run_of(1, 2));
  EXPECT_TRUE(rises.met());
  rises.add(run_of(1, 2, 1), run_of(1, 2));
  EXPECT_EQ(rises.lock_waits(), 1);
  EXPECT_FALSE(rises.met());
}

TEST(Rises, MissTheTargetBeyondATenthAndAFifth) {
  Rises median_too_long;
  median_too_long.add(run_of(1.11, 2), run_of(1, 2));
  EXPECT_FALSE(median_too_long.met());
  Rises tail_too_long;
  tail_too_long.add(run_of(1, 2.42), run_of(1, 2));
  EXPECT_FALSE(tail_too_long.met());
}

}  // namespace
}  // namespace palpate::servo_cost
