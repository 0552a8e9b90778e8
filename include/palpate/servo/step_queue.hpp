#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "palpate/servo/servo_state.hpp"

namespace palpate {

/// Every step of a servo, in order, for one thread that records them. Lock-free; all memory is
/// taken at construction. Where the recorder falls behind by more than there is room for, steps are
/// left out and counted: the servo waits for nobody.
class StepQueue {
 public:
  /// Room for `capacity` steps, rounded up to a power of two.
  explicit StepQueue(std::size_t capacity);
  ~StepQueue();
  StepQueue(const StepQueue&) = delete;
  StepQueue& operator=(const StepQueue&) = delete;

  /// The servo's: puts a step in. Real-time. False: there was no room.
  bool push(const ServoState& state) noexcept;

  /// The recorder's: takes the oldest step out; none: empty.
  [[nodiscard]] std::optional<ServoState> pop() noexcept;

  /// Steps that were left out. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(); }

 private:
  static constexpr std::size_t kCacheLine = 64;

  // Threads that write into one cache line wait for each other.
  std::size_t size_;
  std::unique_ptr<ServoState[]> steps_;
  alignas(kCacheLine) std::atomic<std::uint64_t> pushed_{0};  // the servo writes it, and the next
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> popped_{0};  // the recorder writes it
};

}  // namespace palpate
