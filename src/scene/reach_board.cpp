#include "scene/reach_board.hpp"

namespace palpate {
namespace {

constexpr int kTries = 8;

}  // namespace

void ReachBoard::write(std::size_t place, const Reach& reach) noexcept {
  Place& p = places_[place];
  const std::array<double, 4> values{reach.center.x(), reach.center.y(), reach.center.z(),
                                     reach.radius};
  // Each value's release puts the odd version before it: who sees a new value sees that version.
  const std::uint32_t version = p.version.load(std::memory_order_relaxed);
  p.version.store(version + 1, std::memory_order_relaxed);
  for (std::size_t i = 0; i < values.size(); ++i) {
    p.values[i].store(values[i], std::memory_order_release);
  }
  p.version.store(version + 2, std::memory_order_release);
}

void ReachBoard::read(std::vector<Reach>& found) const {
  found.clear();
  for (const Place& p : places_) {
    for (int i = 0; i < kTries; ++i) {
      const std::uint32_t before = p.version.load(std::memory_order_acquire);
      std::array<double, 4> values{};
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = p.values[k].load(std::memory_order_acquire);
      }
      const std::uint32_t after = p.version.load(std::memory_order_relaxed);
      if (before != after || before % 2 != 0) continue;
      if (values[3] >= 0) found.push_back({{values[0], values[1], values[2]}, values[3]});
      break;
    }
  }
}

}  // namespace palpate
