#include "palpate/servo/servo_state.hpp"

#include <algorithm>
#include <bit>

namespace palpate {

void RecentForces::add(const Eigen::Vector3f& force) noexcept {
  const std::uint64_t count = count_.load(std::memory_order_relaxed);
  Place& place = forces_[count % kSteps];
  for (std::size_t i = 0; i < 3; ++i) {
    place[i].store(force[static_cast<Eigen::Index>(i)], std::memory_order_release);
  }
  count_.store(count + 1, std::memory_order_release);
}

std::vector<Eigen::Vector3f> RecentForces::since(std::uint64_t& seen) const {
  const std::uint64_t end = count_.load(std::memory_order_acquire);
  const std::uint64_t oldest = end > kSteps ? end - kSteps : 0;
  const std::uint64_t begin = std::max(std::min(seen, end), oldest);
  std::vector<Eigen::Vector3f> forces;
  forces.reserve(static_cast<std::size_t>(end - begin));
  for (std::uint64_t i = begin; i < end; ++i) {
    const Place& place = forces_[i % kSteps];
    forces.emplace_back(place[0].load(std::memory_order_acquire),
                        place[1].load(std::memory_order_acquire),
                        place[2].load(std::memory_order_acquire));
  }
  // The step that is under way writes over the place of the one kSteps before it.
  const std::uint64_t now = count_.load(std::memory_order_acquire);
  const std::uint64_t whole = now >= kSteps ? now - kSteps + 1 : 0;
  const std::uint64_t lost = whole > begin ? std::min(whole, end) - begin : 0;
  forces.erase(forces.begin(), forces.begin() + static_cast<std::ptrdiff_t>(lost));
  seen = end;
  return forces;
}

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
