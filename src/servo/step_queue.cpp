#include "palpate/servo/step_queue.hpp"

#include <bit>

namespace palpate {

StepQueue::StepQueue(std::size_t capacity)
    : size_(std::bit_ceil(capacity)), steps_(std::make_unique<ServoState[]>(size_)) {}

StepQueue::~StepQueue() = default;

bool StepQueue::push(const ServoState& state) noexcept {
  const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
  if (at - popped_.load(std::memory_order_acquire) == size_) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  steps_[at % size_] = state;
  pushed_.store(at + 1, std::memory_order_release);
  return true;
}

std::optional<ServoState> StepQueue::pop() noexcept {
  const std::uint64_t at = popped_.load(std::memory_order_relaxed);
  if (at == pushed_.load(std::memory_order_acquire)) return std::nullopt;
  std::optional<ServoState> oldest = steps_[at % size_];
  popped_.store(at + 1, std::memory_order_release);
  return oldest;
}

}  // namespace palpate
