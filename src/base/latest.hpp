#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

namespace palpate {

/// Shows the newest of the values that one thread sets to any number of others: copies, without
/// locks and without memory. Neither side ever waits for the other. Where Handoff shares large
/// things that outlive their readers' steps, this is for small ones: a servo's state for those
/// who watch it, a request for the servo.
///
/// A reader pins the slot that it copies from; the writer takes one that is neither pinned nor the
/// newest. Only when kSlots - 1 readers were interrupted in the middle of copying is a value
/// dropped.
template <class T>
class Latest {
  static_assert(std::is_trivially_destructible_v<T>, "copies take no memory");

 public:
  static constexpr std::size_t kSlots = 8;

  Latest() = default;
  explicit Latest(const T& value) { slots_[0].value = value; }

  /// Makes `value` the newest. One thread at a time. Wait-free. False: dropped (see above).
  bool set(const T& value) noexcept {
    const std::size_t newest = newest_.load();
    for (std::size_t i = 1; i < kSlots; ++i) {
      const std::size_t at = (newest + i) % kSlots;
      if (slots_[at].pins.load() != 0) continue;
      slots_[at].value = value;
      newest_.store(at);
      generation_.fetch_add(1);
      return true;
    }
    return false;
  }

  /// A copy of the newest value; none when the writer was faster than kTries looks. Wait-free.
  [[nodiscard]] std::optional<T> look() const noexcept {
    // The pin is visible before the second look at `newest_`, and the writer moves `newest_` on
    // before it looks at pins; only sequential consistency orders the two (as in Handoff).
    for (int i = 0; i < kTries; ++i) {
      const std::size_t at = newest_.load();
      const Slot& slot = slots_[at];
      slot.pins.fetch_add(1);
      std::optional<T> seen;
      if (newest_.load() == at) seen = slot.value;
      slot.pins.fetch_sub(1);
      if (seen) return seen;
    }
    return std::nullopt;
  }

  /// A copy of the newest value, for those who have time to try again.
  [[nodiscard]] T get() const noexcept {
    while (true) {
      if (const std::optional<T> seen = look()) return *seen;
    }
  }

  /// Grows whenever a value is set: shows whether reading is worth it. Wait-free.
  [[nodiscard]] std::uint64_t generation() const noexcept { return generation_.load(); }

 private:
  static constexpr int kTries = 4;
  static constexpr std::size_t kCacheLine = 64;

  struct alignas(kCacheLine) Slot {
    T value{};
    mutable std::atomic<int> pins{0};
  };

  std::array<Slot, kSlots> slots_;
  std::atomic<std::size_t> newest_{0};
  std::atomic<std::uint64_t> generation_{0};
};

/// The newest value if it was set after generation `seen`, which the caller keeps, from 0 on.
/// Real-time.
template <class T>
[[nodiscard]] std::optional<T> news(const Latest<T>& latest, std::uint64_t& seen) noexcept {
  const std::uint64_t generation = latest.generation();
  if (generation == seen) return std::nullopt;
  const std::optional<T> found = latest.look();
  if (found) seen = generation;
  return found;
}

}  // namespace palpate
