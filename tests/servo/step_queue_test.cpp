#include <gtest/gtest.h>

#include <thread>

#include "palpate/servo/servo.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

ServoState step_of_number(std::uint64_t number) {
  ServoState state;
  state.step = number;
  state.patch_points = number;
  return state;
}

// What neither thread writes, the servo's counters, the recorder's: a cache line each.
static_assert(alignof(ServoState::Queue) == 64 &&
              sizeof(ServoState::Queue) == 3 * alignof(ServoState::Queue));

TEST(StepQueue, GivesStepsInOrderAndCountsThoseThatFoundNoRoom) {
  ServoState::Queue queue(3);  // four
  EXPECT_FALSE(queue.pop());
  for (std::uint64_t i = 1; i <= 6; ++i) EXPECT_EQ(queue.push(step_of_number(i)), i <= 4);
  EXPECT_EQ(queue.dropped(), 2u);
  for (std::uint64_t i = 1; i <= 4; ++i) EXPECT_EQ(queue.pop()->step, i);
  EXPECT_FALSE(queue.pop());
  EXPECT_TRUE(queue.push(step_of_number(7)));
  EXPECT_EQ(queue.pop()->step, 7u);
}

TEST(StepQueue, LosesAndTearsNothingBetweenTwoThreads) {
  ServoState::Queue queue(64);
  const auto count = static_cast<std::uint64_t>(test::effort(100'000));
  std::jthread servo([&](const std::stop_token& stop) {
    for (std::uint64_t i = 1; i <= count; ++i) {
      while (!queue.push(step_of_number(i)) && !stop.stop_requested()) std::this_thread::yield();
    }
  });
  for (std::uint64_t i = 1; i <= count; ++i) {
    std::optional<ServoState> state;
    while (!(state = queue.pop())) std::this_thread::yield();
    ASSERT_EQ(state->step, i);
    ASSERT_EQ(state->patch_points, i);
  }
}

}  // namespace
}  // namespace palpate
