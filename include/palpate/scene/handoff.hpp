#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <memory>
#include <mutex>
#include <vector>

namespace palpate {

/// Hands immutable values from preparing threads to several real-time readers without locks: the
/// one place where threads meet. A reader marks what it looks at in a slot of its own (a hazard
/// pointer); a value is freed by the next publish() or leave() that finds no slot naming it, on
/// that thread and never on a reader's.
///
/// A reader that stands still keeps the values in its slots alive and delays nobody; so at most
/// kReaders * kHeld + 1 values are alive at a time, however many are published.
template <class T>
class Handoff {
  static_assert(std::atomic<const T*>::is_always_lock_free);

 public:
  static constexpr std::size_t kReaders = 16;
  /// A reader holds at most two values: the current and the next one.
  static constexpr std::size_t kHeld = 2;

  Handoff() = default;
  Handoff(const Handoff&) = delete;
  Handoff& operator=(const Handoff&) = delete;
  /// Every reader has left by now.
  ~Handoff() {
    assert(std::ranges::none_of(taken_, [](bool taken) { return taken; }));
  }

  /// Takes a reader's place. Not real-time. Returns kReaders when all places are taken.
  [[nodiscard]] std::size_t join() {
    const std::lock_guard lock(mutex_);
    const auto place = std::ranges::find(taken_, false);
    if (place != taken_.end()) *place = true;
    return static_cast<std::size_t>(std::distance(taken_.begin(), place));
  }

  /// Gives a place back. Not real-time; the reader must no longer use what it held.
  void leave(std::size_t reader) {
    Values unused;  // outlives the lock: what it holds is freed after the unlocking
    const std::lock_guard lock(mutex_);
    assert(reader < kReaders && taken_[reader]);
    for (auto& slot : readers_[reader].slots) slot.store(nullptr);
    taken_[reader] = false;
    unused = take_unused();
  }

  /// Makes `value` the newest; a null one says that there is nothing any more. Not real-time. Frees
  /// what no reader holds any more.
  void publish(std::unique_ptr<const T> value) {
    Values unused;
    const std::lock_guard lock(mutex_);
    const T* newest = value.get();
    if (newest) values_.push_back(std::move(value));  // first: this may throw
    newest_.store(newest);
    unused = take_unused();
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
  [[nodiscard]] std::size_t alive() {
    const std::lock_guard lock(mutex_);
    return values_.size();
  }

 private:
  using Values = std::vector<std::unique_ptr<const T>>;

  static constexpr int kTries = 4;
  static constexpr std::size_t kCacheLine = 64;

  /// A reader writes on a cache line of its own.
  struct alignas(kCacheLine) Reader {
    std::array<std::atomic<const T*>, kHeld> slots{};
  };

  /// Moves what nobody needs out of `values_`. The mutex is held. Looks at each slot once; a
  /// value that is not the newest cannot become marked afterwards (see acquire()).
  [[nodiscard]] Values take_unused() {
    const T* newest = newest_.load();
    const auto kept = std::partition(values_.begin(), values_.end(), [&](const auto& value) {
      return value.get() == newest || held(value.get());
    });
    Values unused(std::make_move_iterator(kept), std::make_move_iterator(values_.end()));
    values_.erase(kept, values_.end());
    return unused;
  }

  [[nodiscard]] bool held(const T* value) const {
    return std::ranges::any_of(readers_, [value](const Reader& reader) {
      return std::ranges::any_of(reader.slots,
                                 [value](const auto& slot) { return slot.load() == value; });
    });
  }

  std::mutex mutex_;  // publishers and those who join or leave; never taken by acquire()
  Values values_;
  std::array<bool, kReaders> taken_{};
  std::atomic<const T*> newest_{nullptr};
  std::array<Reader, kReaders> readers_{};
};

}  // namespace palpate
