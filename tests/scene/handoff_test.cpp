// Checks that snapshots pass between threads without locks or leaks.
#include "scene/handoff.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace palpate {
namespace {

// A value that knows whether it is alive and how many of its kind are.
class Counted {
 public:
  Counted(std::uint64_t number, std::atomic<int>& alive) : number_(number), alive_(alive) {
    words_.fill(number);
    ++alive_;
  }
  ~Counted() {
    words_.fill(0);
    --alive_;
  }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] bool whole() const {
    for (const auto word : words_) {
      if (word != number_) return false;
    }
    return true;
  }

 private:
  std::uint64_t number_;
  std::array<std::uint64_t, 32> words_{};
  std::atomic<int>& alive_;
};

class HandoffTest : public testing::Test {
 protected:
  void publish(std::uint64_t number) {
    handoff_.publish(std::make_unique<const Counted>(number, alive_));
  }

  std::atomic<int> alive_{0};
  Handoff<Counted> handoff_;
};

TEST_F(HandoffTest, IsEmptyAtFirst) {
  const std::size_t reader = handoff_.join();
  EXPECT_EQ(handoff_.acquire(reader, 0), nullptr);
  EXPECT_EQ(handoff_.peek(), nullptr);
  EXPECT_EQ(handoff_.alive(), 0u);
  handoff_.leave(reader);
}

TEST_F(HandoffTest, GivesTheNewest) {
  const std::size_t reader = handoff_.join();
  publish(1);
  publish(2);
  const Counted* value = handoff_.acquire(reader, 0);
  ASSERT_NE(value, nullptr);
  EXPECT_EQ(value->number(), 2u);
  EXPECT_EQ(handoff_.peek(), value);
  handoff_.leave(reader);
}

TEST_F(HandoffTest, FreesAtOnceWhatNobodyHolds) {
  for (std::uint64_t i = 1; i <= 10; ++i) publish(i);
  EXPECT_EQ(alive_, 1);
}

TEST_F(HandoffTest, KeepsWhatASlotHoldsAndFreesItAfterwards) {
  const std::size_t reader = handoff_.join();
  publish(1);
  const Counted* first = handoff_.acquire(reader, 0);
  publish(2);
  publish(3);
  EXPECT_EQ(first->number(), 1u);
  EXPECT_EQ(alive_, 2);

  handoff_.release(reader, 0);
  EXPECT_EQ(alive_, 2) << "a reader must never free";
  publish(4);
  EXPECT_EQ(alive_, 1);
  handoff_.leave(reader);
}

TEST_F(HandoffTest, HoldsTwoValuesInTwoSlots) {
  const std::size_t reader = handoff_.join();
  publish(1);
  const Counted* current = handoff_.acquire(reader, 0);
  publish(2);
  const Counted* next = handoff_.acquire(reader, 1);
  publish(3);
  EXPECT_EQ(current->number(), 1u);
  EXPECT_EQ(next->number(), 2u);
  EXPECT_EQ(alive_, 3);

  EXPECT_EQ(handoff_.acquire(reader, 0)->number(), 3u);
  publish(4);
  EXPECT_EQ(alive_, 3) << "2 and 3 are held, 4 is the newest; 1 went when its slot was used again";
  handoff_.leave(reader);
  EXPECT_EQ(alive_, 1);
}

TEST_F(HandoffTest, LeavingFreesWhatTheReaderHeld) {
  const std::size_t reader = handoff_.join();
  publish(1);
  ASSERT_NE(handoff_.acquire(reader, 1), nullptr);
  publish(2);
  handoff_.leave(reader);
  EXPECT_EQ(alive_, 1);
}

TEST_F(HandoffTest, NullTakesTheSurfaceAway) {
  const std::size_t reader = handoff_.join();
  publish(1);
  const Counted* held = handoff_.acquire(reader, 0);
  handoff_.publish(nullptr);
  EXPECT_EQ(handoff_.peek(), nullptr);
  EXPECT_TRUE(held->whole());
  EXPECT_EQ(handoff_.acquire(reader, 0), nullptr);
  handoff_.publish(nullptr);
  EXPECT_EQ(handoff_.alive(), 0u);
  handoff_.leave(reader);
}

TEST_F(HandoffTest, TellsWhenAllPlacesAreTakenAndUsesThemAgain) {
  constexpr std::size_t kReaders = Handoff<Counted>::kReaders;
  std::vector<std::size_t> readers;
  for (std::size_t i = 0; i < kReaders; ++i) readers.push_back(handoff_.join());
  EXPECT_EQ(handoff_.join(), kReaders);
  handoff_.leave(readers[5]);
  EXPECT_EQ(handoff_.join(), readers[5]);
  for (const std::size_t reader : readers) handoff_.leave(reader);
}

TEST_F(HandoffTest, FullOfStuckReadersKeepsABoundedNumberAlive) {
  constexpr std::size_t kReaders = Handoff<Counted>::kReaders;
  constexpr std::size_t kHeld = Handoff<Counted>::kHeld;
  for (std::size_t reader = 0; reader < kReaders; ++reader) {
    ASSERT_EQ(handoff_.join(), reader);
    for (std::size_t slot = 0; slot < kHeld; ++slot) {
      publish(reader * kHeld + slot + 1);
      ASSERT_NE(handoff_.acquire(reader, slot), nullptr);
    }
  }
  for (std::uint64_t i = 0; i < 100; ++i) publish(1000 + i);
  EXPECT_EQ(handoff_.alive(), kReaders * kHeld + 1);
  for (std::size_t reader = 0; reader < kReaders; ++reader) handoff_.leave(reader);
  EXPECT_EQ(alive_, 1);
}

// What a reader thread found.
struct ReadValues {
  std::uint64_t looks = 0;
  std::uint64_t misses = 0;
  std::uint64_t torn = 0;       // a value that was freed or half written
  std::uint64_t backwards = 0;  // an older value after a newer one
  std::uint64_t last = 0;
};

// Reads as a field does: keeps the current value in one slot and takes the newest into the other.
ReadValues read_until(Handoff<Counted>& handoff, std::size_t reader,
                      const std::atomic<bool>& done) {
  ReadValues seen;
  std::size_t slot = 0;
  const Counted* current = nullptr;
  while (!done.load() || seen.looks == 0) {
    const Counted* next = handoff.acquire(reader, slot);
    ++seen.looks;
    if (next) {
      if (current && current != next && !current->whole()) ++seen.torn;
      if (!next->whole()) ++seen.torn;
      if (next->number() < seen.last) ++seen.backwards;
      seen.last = next->number();
      current = next;
      slot = 1 - slot;
    } else {
      ++seen.misses;
    }
    if (current && !current->whole()) ++seen.torn;
  }
  return seen;
}

// One publisher, three readers at full speed and one that took two values and stopped for good.
TEST_F(HandoffTest, ThreadsNeverSeeAFreedOrOlderValue) {
  constexpr std::uint64_t kPublished = 20000;
  publish(1);
  const std::size_t stuck = handoff_.join();
  const Counted* stuck_first = handoff_.acquire(stuck, 0);
  publish(2);
  const Counted* stuck_second = handoff_.acquire(stuck, 1);

  std::atomic<bool> done{false};
  std::array<ReadValues, 3> seen{};
  std::array<std::size_t, 3> readers{};
  for (auto& reader : readers) reader = handoff_.join();
  int most_alive = 0;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < readers.size(); ++i) {
      threads.emplace_back([&, i] { seen[i] = read_until(handoff_, readers[i], done); });
    }
    for (std::uint64_t i = 3; i <= kPublished; ++i) {
      publish(i);
      most_alive = std::max(most_alive, alive_.load());
    }
    done = true;
  }

  for (const ReadValues& reader : seen) {
    EXPECT_EQ(reader.torn, 0u);
    EXPECT_EQ(reader.backwards, 0u);
    EXPECT_GT(reader.looks, reader.misses) << "a reader never got a value";
  }
  EXPECT_EQ(stuck_first->number(), 1u);
  EXPECT_EQ(stuck_second->number(), 2u);
  EXPECT_TRUE(stuck_first->whole() && stuck_second->whole());
  EXPECT_LE(most_alive, 4 * 2 + 2) << "two a reader, the newest, and one being swapped";

  for (const std::size_t reader : readers) handoff_.leave(reader);
  handoff_.leave(stuck);
  EXPECT_EQ(alive_, 1);
}

// Readers that come and go while values are published.
TEST_F(HandoffTest, ThreadsMayJoinAndLeaveMeanwhile) {
  std::atomic<bool> done{false};
  std::atomic<int> torn{0};
  const auto come_and_go = [&] {
    while (!done) {
      const std::size_t reader = handoff_.join();
      for (int i = 0; i < 5; ++i) {
        const Counted* value = handoff_.acquire(reader, static_cast<std::size_t>(i % 2));
        if (value && !value->whole()) ++torn;
      }
      handoff_.leave(reader);
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 3; ++i) threads.emplace_back(come_and_go);
    for (std::uint64_t i = 1; i <= 3000; ++i) publish(i);
    done = true;
  }
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(handoff_.alive(), 1u);
  EXPECT_EQ(alive_, 1);
}

}  // namespace
}  // namespace palpate
