#include "base/latest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "support/effort.hpp"

namespace palpate {
namespace {

// Large enough that a copy is interrupted now and then; torn when its numbers differ.
struct Large {
  std::array<std::uint64_t, 64> numbers{};

  explicit Large(std::uint64_t number = 0) { numbers.fill(number); }
  [[nodiscard]] bool whole() const {
    for (const std::uint64_t number : numbers) {
      if (number != numbers.front()) return false;
    }
    return true;
  }
};

TEST(Latest, ShowsTheNewestValue) {
  Latest<int> latest(7);
  EXPECT_EQ(latest.get(), 7);
  for (int i = 0; i < 30; ++i) {
    const std::uint64_t generation = latest.generation();
    EXPECT_TRUE(latest.set(i));
    EXPECT_EQ(latest.get(), i);
    EXPECT_GT(latest.generation(), generation);
  }
}

TEST(Latest, ShowsWholeValuesInOrderToManyReadersAtOnce) {
  Latest<Large> latest;
  std::atomic<bool> done = false;
  std::atomic<int> torn = 0;
  std::atomic<int> back = 0;
  std::vector<std::jthread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      std::uint64_t before = 0;
      while (!done) {
        const Large seen = latest.get();
        torn += seen.whole() ? 0 : 1;
        back += seen.numbers[0] < before ? 1 : 0;
        before = seen.numbers[0];
      }
    });
  }
  const auto count = static_cast<std::uint64_t>(test::effort(200'000));
  std::uint64_t dropped = 0;
  for (std::uint64_t i = 1; i <= count; ++i) dropped += latest.set(Large(i)) ? 0 : 1;
  done = true;
  readers.clear();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(back, 0);
  EXPECT_EQ(dropped, 0u) << "three readers pin three slots at most";
  EXPECT_EQ(latest.get().numbers[0], count);
}

}  // namespace
}  // namespace palpate
