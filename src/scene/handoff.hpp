#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace palpate {

/// Hands immutable values from preparing threads to several real-time readers without locks: the
/// one point where threads meet. A reader marks what it looks at in a slot of its own (a hazard
/// pointer); a value is let go by the next publish() or leave() that finds no slot naming it, on
/// that thread and never on a reader's.
///
/// A reader that stands still keeps the values in its slots alive and delays nobody; so at most
/// kReaders * kHeld values and the newest are alive at a time, however many are published; during a
/// publish() one more, and one for each reader that changes a slot just then. Nothing here
/// allocates but join().
template <class T>
class Handoff {
  static_assert(std::atomic<const T*>::is_always_lock_free);

 public:
  /// Threads that may read at a time (judgement: more than there are hands and windows).
  static constexpr std::size_t kReaders = 16;
  /// A reader holds at most two values: the current and the next one.
  static constexpr std::size_t kHeld = 2;

  Handoff() = default;
  Handoff(const Handoff&) = delete;
  Handoff& operator=(const Handoff&) = delete;
  /// Every reader has left by now.
  ~Handoff() { assert(readers() == 0); }

  /// Registers a reader and returns its number, kReaders when there are as many already. Not
  /// real-time. `name`: for those who look for a reader that stands still.
  [[nodiscard]] std::size_t join(std::string name = {}) {
    const std::lock_guard lock(mutex_);
    const auto free = std::ranges::find(taken_, false);
    const auto reader = static_cast<std::size_t>(std::distance(taken_.begin(), free));
    if (reader == kReaders) return kReaders;
    taken_[reader] = true;
    names_[reader] = std::move(name);
    return reader;
  }

  /// Ends a registration. Not real-time; the reader must no longer use what it held.
  void leave(std::size_t reader) {
    Values unused;  // outlives the lock: what it holds is let go after the unlocking
    const std::lock_guard lock(mutex_);
    assert(reader < kReaders && taken_[reader]);
    for (auto& slot : readers_[reader].slots) slot.store(nullptr);
    taken_[reader] = false;
    take_unused(unused);
  }

  /// Makes `value` the newest; a null one means that there is nothing any more. Not real-time. Lets
  /// go of what no reader holds any more.
  void publish(std::shared_ptr<const T> value) {
    Values unused;
    const std::lock_guard lock(mutex_);
    const T* newest = value.get();
    const auto end = values_.begin() + static_cast<std::ptrdiff_t>(count_);
    const bool listed =
        std::any_of(values_.begin(), end, [&](const auto& other) { return other.get() == newest; });
    if (newest && !listed) values_[count_++] = std::move(value);
    newest_.store(newest);
    take_unused(unused);
  }

  /// The newest value, held in `slot` (< kHeld) of `reader` until the slot is used again; nullptr
  /// when there is none, or when publishers were faster than kTries looks (then the slot is empty
  /// and the caller keeps what its other slot holds). Wait-free.
  [[nodiscard]] const T* acquire(std::size_t reader, std::size_t slot) noexcept {
    // The mark must be visible before the second look, and publish() must show the new value before
    // it looks at the marks: only sequential consistency orders a store before a later load. So
    // if the second look still finds `seen`, every later take_unused() finds the mark. `seen` may
    // have been freed and its address used again in between; then it is the newest value all
    // the same, and that is what the caller gets.
    auto& mark = readers_[reader].slots[slot];
    const T* seen = newest_.load();
    for (int i = 0; i < kTries; ++i) {
      mark.store(seen);
      const T* again = newest_.load();
      if (again == seen) return seen;
      seen = again;
    }
    mark.store(nullptr);
    return nullptr;
  }

  /// Empties a slot. Wait-free.
  void release(std::size_t reader, std::size_t slot) noexcept {
    readers_[reader].slots[slot].store(nullptr);
  }

  /// The newest value without holding it: only to compare with one that is held, whose address
  /// cannot be used again. Wait-free.
  [[nodiscard]] const T* peek() const noexcept { return newest_.load(); }

  /// How many values are alive. Not real-time.
  [[nodiscard]] std::size_t alive() const {
    const std::lock_guard lock(mutex_);
    return count_;
  }

  /// How many readers are registered. Not real-time.
  [[nodiscard]] std::size_t readers() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count(taken_, true));
  }

  /// Lets go of what no reader holds any more, as publish() does. Not real-time.
  void sweep() {
    Values unused;
    const std::lock_guard lock(mutex_);
    take_unused(unused);
  }

  /// The name of a reader that holds the oldest value of all; empty when none is held but the
  /// newest. Not real-time.
  [[nodiscard]] std::string slowest() const {
    const std::lock_guard lock(mutex_);
    for (std::size_t v = 0; v < count_; ++v) {
      const T* const value = values_[v].get();
      if (value == newest_.load()) continue;
      const auto holder = std::ranges::find_if(
          readers_, [value](const Reader& reader) { return holds(reader, value); });
      if (holder == readers_.end()) continue;
      return names_[static_cast<std::size_t>(std::distance(readers_.begin(), holder))];
    }
    return {};
  }

 private:
  static constexpr int kTries = 4;               // looks; bounds the wait (judgement)
  static constexpr std::size_t kCacheLine = 64;  // bytes, on x86-64 and most Arm cores
  // What readers hold, the newest and one that is being published; and a reader that changes a slot
  // while it is being looked at may keep two values by it.
  static constexpr std::size_t kMostValues = kReaders * kHeld + kReaders + 2;

  using Values = std::array<std::shared_ptr<const T>, kMostValues>;

  /// A reader writes on a cache line of its own.
  struct alignas(kCacheLine) Reader {
    std::array<std::atomic<const T*>, kHeld> slots{};
  };

  /// Moves what nobody needs out of `values_`, whose order stays. The mutex is held. Looks at
  /// each slot once; a value that is not the newest cannot become marked afterwards (see
  /// acquire()).
  void take_unused(Values& unused) {
    const T* const newest = newest_.load();
    std::size_t kept = 0;
    for (std::size_t v = 0; v < count_; ++v) {
      const T* const value = values_[v].get();
      const bool needed = value == newest || std::ranges::any_of(readers_, [&](const auto& reader) {
                            return holds(reader, value);
                          });
      auto& target = needed ? values_[kept++] : unused[v];
      if (&target != &values_[v]) target = std::move(values_[v]);
    }
    count_ = kept;
  }

  [[nodiscard]] static bool holds(const Reader& reader, const T* value) {
    return std::ranges::any_of(reader.slots,
                               [value](const auto& slot) { return slot.load() == value; });
  }

  mutable std::mutex mutex_;  // publishers and those who join or leave; never taken by acquire()
  Values values_;             // the first count_, oldest first
  std::size_t count_ = 0;
  std::array<bool, kReaders> taken_{};
  std::array<std::string, kReaders> names_;
  std::atomic<const T*> newest_{nullptr};
  std::array<Reader, kReaders> readers_{};
};

}  // namespace palpate
