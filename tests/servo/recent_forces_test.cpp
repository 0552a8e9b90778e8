#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "servo/servo_inside.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

Eigen::Vector3f numbered(std::uint64_t i) {
  const auto f = static_cast<float>(i);
  return {f, f, f};
}

TEST(RecentForces, GivesWhatWasAddedSinceTheLastLookOldestFirst) {
  RecentForces recent;
  std::uint64_t seen = 0;
  EXPECT_TRUE(recent.since(seen).empty());
  for (std::uint64_t i = 0; i < 3; ++i) recent.add(numbered(i));
  const auto first = recent.since(seen);
  ASSERT_EQ(first.size(), 3u);
  EXPECT_EQ(first.front().x(), 0);
  EXPECT_EQ(first.back().z(), 2);
  EXPECT_EQ(seen, 3u);
  recent.add(numbered(3));
  ASSERT_EQ(recent.since(seen).size(), 1u);
  EXPECT_TRUE(recent.since(seen).empty());
}

TEST(RecentForces, WhoLooksTooRarelyGetsTheNewestOnes) {
  RecentForces recent;
  const std::uint64_t all = 3 * RecentForces::kSteps + 7;
  for (std::uint64_t i = 0; i < all; ++i) recent.add(numbered(i));
  std::uint64_t seen = 0;
  const auto forces = recent.since(seen);
  ASSERT_EQ(forces.size(), RecentForces::kSteps - 1);
  EXPECT_EQ(forces.back().x(), static_cast<float>(all - 1));
  EXPECT_EQ(forces.front().x(), static_cast<float>(all - RecentForces::kSteps + 1));
  EXPECT_EQ(seen, all);
}

TEST(RecentForces, AForceIsNeverHalfOneAndHalfAnother) {
  RecentForces recent;
  const auto all = static_cast<std::uint64_t>(test::effort(2'000'000));
  std::thread servo([&] {
    for (std::uint64_t i = 0; i < all; ++i) recent.add(numbered(i));
  });
  std::uint64_t seen = 0;
  while (seen < all) {
    const std::uint64_t before = seen;
    const auto forces = recent.since(seen);
    std::uint64_t i = seen - forces.size();
    ASSERT_GE(i, before);
    for (const Eigen::Vector3f& force : forces) {
      ASSERT_EQ(force, numbered(i));
      ++i;
    }
  }
  servo.join();
}

}  // namespace
}  // namespace palpate
