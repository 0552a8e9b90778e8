#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <thread>

#include "palpate/device/simulated.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(RemoteTarget, IsHeldFromItsFirstPoseUntilItIsReleased) {
  RemoteTarget hand;
  EXPECT_FALSE(hand.command()->held);
  EXPECT_TRUE(hand.move({{0.1, 0, 0}, 5}, 3));
  EXPECT_TRUE(hand.command()->held);
  EXPECT_EQ(hand.command()->target.position, Vector3d(0.1, 0, 0));
  EXPECT_EQ(hand.command()->target.buttons, 5u);
  EXPECT_EQ(hand.command()->stamp, 3);
  hand.release();
  EXPECT_FALSE(hand.command()->held);
}

TEST(RemoteTarget, KeepingIsHeardButIsNoNewPose) {
  RemoteTarget hand;
  hand.keep_alive();
  EXPECT_EQ(hand.generation(), 0u) << "nobody has it";
  static_cast<void>(hand.move({}, 0));
  const std::uint64_t generation = hand.generation();
  hand.keep_alive();
  EXPECT_GT(hand.generation(), generation);
  EXPECT_EQ(hand.command()->moves, 1u);
}

TEST(RemoteTarget, LeavesOutPosesThatAreNotFinite) {
  RemoteTarget hand;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(hand.move({{0, nan, 0}, 0}, 1));
  EXPECT_FALSE(hand.move({{0, 0, 0}, 0}, nan));
  EXPECT_FALSE(hand.move({.opening = nan}, 1));
  EXPECT_FALSE(hand.move({.orientation = Eigen::Quaterniond(1, 1, 0, 0)}, 1))
      << "of no unit length";
  EXPECT_FALSE(hand.move({.orientation = Eigen::Quaterniond(nan, 1, 0, 0)}, 1));
  EXPECT_FALSE(hand.command()->held);
  EXPECT_EQ(hand.generation(), 0u);
}

TEST(RemoteTarget, ListenersSeeWholePosesWhileAnotherThreadSpeaks) {
  RemoteTarget hand;
  const int count = test::effort(100'000);
  const std::jthread speaker([&] {
    for (int i = 1; i <= count; ++i) {
      static_cast<void>(
          hand.move({Vector3d::Constant(i), static_cast<std::uint32_t>(i)}, 1e-3 * i));
    }
  });
  for (double last = 0; last < count;) {
    const std::optional<RemoteTarget::Command> word = hand.command();
    if (!word || !word->held) continue;
    const double x = word->target.position.x();
    ASSERT_EQ(word->target.position, Vector3d::Constant(x));
    ASSERT_EQ(word->target.buttons, static_cast<std::uint32_t>(x));
    ASSERT_GE(x, last);
    last = x;
  }
}

}  // namespace
}  // namespace palpate
