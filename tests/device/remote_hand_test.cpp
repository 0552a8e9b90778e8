#include "palpate/device/remote_hand.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>

#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(RemoteHand, IsHeldFromItsFirstPoseUntilItIsReleased) {
  RemoteHand hand;
  EXPECT_FALSE(hand.look()->held);
  EXPECT_TRUE(hand.move({{{0.1, 0, 0}, 5}, 3}));
  EXPECT_TRUE(hand.look()->held);
  EXPECT_EQ(hand.look()->pose.wish.position, Vector3d(0.1, 0, 0));
  EXPECT_EQ(hand.look()->pose.wish.buttons, 5u);
  EXPECT_EQ(hand.look()->pose.stamp, 3);
  hand.release();
  EXPECT_FALSE(hand.look()->held);
}

TEST(RemoteHand, KeepingIsHeardButIsNoNewPose) {
  RemoteHand hand;
  hand.keep();
  EXPECT_EQ(hand.generation(), 0u) << "nobody has it";
  static_cast<void>(hand.move({}));
  const std::uint64_t generation = hand.generation();
  hand.keep();
  EXPECT_GT(hand.generation(), generation);
  EXPECT_EQ(hand.look()->poses, 1u);
}

TEST(RemoteHand, LeavesOutPosesThatAreNotFinite) {
  RemoteHand hand;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(hand.move({{{0, nan, 0}, 0}, 1}));
  EXPECT_FALSE(hand.move({{{0, 0, 0}, 0}, nan}));
  EXPECT_FALSE(hand.look()->held);
  EXPECT_EQ(hand.generation(), 0u);
}

TEST(RemoteHand, ListenersSeeWholePosesWhileAnotherThreadSpeaks) {
  RemoteHand hand;
  std::atomic<bool> done{false};
  std::jthread speaker([&] {
    for (int i = 1; i <= test::effort(100'000); ++i) {
      static_cast<void>(
          hand.move({{Vector3d::Constant(i), static_cast<std::uint32_t>(i)}, 1e-3 * i}));
    }
    done.store(true);
  });
  double last = 0;
  while (!done.load()) {
    const std::optional<HandWord> word = hand.look();
    if (!word || !word->held) continue;
    const double x = word->pose.wish.position.x();
    ASSERT_EQ(word->pose.wish.position, Vector3d::Constant(x));
    ASSERT_EQ(word->pose.wish.buttons, static_cast<std::uint32_t>(x));
    ASSERT_GE(x, last);
    last = x;
  }
}

}  // namespace
}  // namespace palpate
