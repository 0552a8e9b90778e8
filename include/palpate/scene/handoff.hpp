#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace palpate {

/// Hands immutable values from one preparing thread to several real-time readers without locks:
/// the one place where threads meet. A reader marks what it looks at in a slot of its own (a hazard
/// pointer); the publisher frees a value once no slot names it.
template <class T>
class Handoff {
 public:
  static constexpr std::size_t kReaders = 16;
  /// A reader holds at most two values: the current and the next one.
  static constexpr std::size_t kHeld = 2;

  Handoff() = default;
  Handoff(const Handoff&) = delete;
  Handoff& operator=(const Handoff&) = delete;
  ~Handoff() = default;

  /// Takes a reader's place. Not real-time. Returns kReaders when all places are taken.
  [[nodiscard]] std::size_t join() {
    const std::lock_guard lock(mutex_);
    for (std::size_t reader = 0; reader < kReaders; ++reader) {
      if (!taken_[reader]) {
        taken_[reader] = true;
        return reader;
      }
    }
    return kReaders;
  }

  /// Gives a place back. Not real-time; the reader must no longer use what it held.
  void leave(std::size_t reader) {
    const std::lock_guard lock(mutex_);
    for (auto& slot : slots_[reader]) slot.store(nullptr);
    taken_[reader] = false;
    free_unused();
  }

  /// Makes `value` the newest. Not real-time. Frees what no reader holds any more.
  void publish(std::unique_ptr<const T> value) {
    const std::lock_guard lock(mutex_);
    newest_.store(value.get());
    values_.push_back(std::move(value));
    free_unused();
  }

  /// The newest value, held in `slot` (< kHeld) of `reader` until the slot is used again; nullptr
  /// when there is none, or when publishers were faster than kTries looks (then the slot is empty
  /// and the caller keeps what its other slot holds). Wait-free.
  [[nodiscard]] const T* acquire(std::size_t reader, std::size_t slot) noexcept {
    auto& hazard = slots_[reader][slot];
    const T* seen = newest_.load();
    for (int i = 0; i < kTries; ++i) {
      hazard.store(seen);
      const T* again = newest_.load();
      if (again == seen) return seen;
      seen = again;
    }
    hazard.store(nullptr);
    return nullptr;
  }

  /// Empties a slot. Wait-free.
  void release(std::size_t reader, std::size_t slot) noexcept {
    slots_[reader][slot].store(nullptr);
  }

  /// The newest value without holding it: only to compare with. Wait-free.
  [[nodiscard]] const T* peek() const noexcept { return newest_.load(); }

  /// How many values are alive. Not real-time.
  [[nodiscard]] std::size_t alive() {
    const std::lock_guard lock(mutex_);
    return values_.size();
  }

 private:
  static constexpr int kTries = 4;

  void free_unused() {
    std::erase_if(values_, [this](const auto& value) {
      return value.get() != newest_.load() && !held(value.get());
    });
  }

  [[nodiscard]] bool held(const T* value) const {
    for (const auto& reader : slots_) {
      for (const auto& slot : reader) {
        if (slot.load() == value) return true;
      }
    }
    return false;
  }

  std::mutex mutex_;  // publishers and those who join or leave; never taken by acquire()
  std::vector<std::unique_ptr<const T>> values_;
  std::array<bool, kReaders> taken_{};
  std::atomic<const T*> newest_{nullptr};
  std::array<std::array<std::atomic<const T*>, kHeld>, kReaders> slots_{};
};

}  // namespace palpate
