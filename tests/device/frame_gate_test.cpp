// Who may speak to a library: the frames of several devices, or somebody who opens one.
#include "device/frame_gate.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

namespace palpate::device {
namespace {

class FrameGateTest : public testing::Test {
 protected:
  FrameGateTest() { gate_.add(lane_); }

  // What each tick does; true: it would speak for its device.
  bool tick() {
    if (lane_->stands(gate_.turn()) || !lane_->enter()) return false;
    const std::uint64_t turn = gate_.turn();
    const bool is_closed = FrameGate::is_closed(turn);
    if (is_closed) lane_->stand(turn);
    lane_->leave();
    return !is_closed;
  }
  [[nodiscard]] bool is_still() { return FrameGate::Stillness(gate_, 0).all(); }

  FrameGate gate_;
  std::shared_ptr<FrameLane> lane_ = std::make_shared<FrameLane>();
};

TEST_F(FrameGateTest, FramesStandStillWhileItIsClosed) {
  EXPECT_TRUE(tick());
  {
    const FrameGate::Stillness stillness(gate_, 0);
    EXPECT_FALSE(stillness.all()) << "it has not ticked yet";
    EXPECT_FALSE(tick());
    EXPECT_FALSE(tick());
  }
  EXPECT_TRUE(tick());
}

TEST_F(FrameGateTest, WhoStoodStillInAnEarlierTurnIsWaitedForAgain) {
  {
    const FrameGate::Stillness stillness(gate_, 0);
    EXPECT_FALSE(tick());
  }
  EXPECT_FALSE(is_still());
  EXPECT_TRUE(tick());
}

TEST_F(FrameGateTest, WhoIsOverIsNotWaitedFor) {
  EXPECT_TRUE(gate_.is_used());
  lane_->end();
  EXPECT_FALSE(gate_.is_used());
  EXPECT_TRUE(is_still());
}

TEST_F(FrameGateTest, AFrameThatSpeaksIsNotGivenUp) {
  ASSERT_TRUE(lane_->enter());
  EXPECT_FALSE(lane_->give_up());
  lane_->leave();
  EXPECT_TRUE(lane_->give_up());
  EXPECT_FALSE(lane_->enter());
  EXPECT_TRUE(lane_->is_over());
}

TEST_F(FrameGateTest, NobodySpeaksTogetherWithWhoHasClosedIt) {
  int owner = 0;  // not atomic: for the thread sanitizer, and for those who count
  int ticks = 0;
  std::atomic<bool> done{false};
  std::thread frames([&] {
    while (!done) {
      if (lane_->stands(gate_.turn()) || !lane_->enter()) continue;
      const std::uint64_t turn = gate_.turn();
      ++owner;
      ++ticks;
      if (FrameGate::is_closed(turn)) lane_->stand(turn);
      lane_->leave();
    }
  });
  int closed = 0;
  for (int i = 0; i < 1000; ++i) {
    const FrameGate::Stillness stillness(gate_, 60);
    if (!stillness.all()) break;
    const int before = owner;
    ++owner;
    if (owner == before + 1) ++closed;
  }
  done = true;
  frames.join();
  EXPECT_EQ(closed, 1000);
  EXPECT_EQ(owner, ticks + closed);
}

}  // namespace
}  // namespace palpate::device
