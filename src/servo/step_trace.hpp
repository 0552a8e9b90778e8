#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "palpate/servo/servo.hpp"

namespace palpate {

/// All that a servo's step depended on besides the servo's options and the steps before: with it
/// the step can be done again, to the same force, bit for bit.
struct StepInput {
  DeviceState device;
  SceneField::Found found;
  bool reset = false;                           ///< Servo::reset() was called
  std::optional<ContactSettings> contact = {};  ///< where it was changed for this step
  std::optional<FieldOptions> field = {};       ///< likewise
  std::optional<Eigen::Vector3d> added = {};    ///< a new Servo::add_force(), N
};

/// A step with what it was made of.
struct StepTrace {
  ServoState state;
  StepInput input;
};

/// Steps on their way from a servo to a recorder. Lock-free; all memory is taken at construction.
/// Where the recorder falls behind by more than there is room for, steps are left out and counted.
class StepTraces {
 public:
  /// Room for `capacity` steps, rounded up to a power of two.
  explicit StepTraces(std::size_t capacity)
      : size_(std::bit_ceil(capacity)), steps_(std::make_unique<StepTrace[]>(size_)) {}

  /// The servo's. Real-time.
  void push(const ServoState& state, const StepInput& input) noexcept {
    const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
    if (at - popped_.load(std::memory_order_acquire) == size_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    steps_[at % size_] = {state, input};
    pushed_.store(at + 1, std::memory_order_release);
  }

  /// The recorder's: the oldest step, there until drop(); null: there is none.
  [[nodiscard]] const StepTrace* front() const noexcept {
    const std::uint64_t at = popped_.load(std::memory_order_relaxed);
    return at == pushed_.load(std::memory_order_acquire) ? nullptr : &steps_[at % size_];
  }
  void drop() noexcept { popped_.fetch_add(1, std::memory_order_release); }

  /// Is half of the room taken? Any thread.
  [[nodiscard]] bool fills() const noexcept { return 2 * (pushed_ - popped_) > size_; }

  /// Steps that were left out. Any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(); }

 private:
  static constexpr std::size_t kCacheLine = 64;

  // Threads that write into one cache line wait for each other.
  std::size_t size_;
  std::unique_ptr<StepTrace[]> steps_;
  alignas(kCacheLine) std::atomic<std::uint64_t> pushed_{0};  // the servo writes it, and the next
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> popped_{0};  // the recorder writes it
};

}  // namespace palpate
