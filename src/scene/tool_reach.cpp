// Foresees where tools can be, and passes that from fields to preparation.
#include "scene/tool_reach.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr int kTries = 8;  // reads of one slot; bounds the wait (judgement)

}  // namespace

void ReachTable::write(std::size_t slot, const Reach& reach) noexcept {
  Slot& p = slots_[slot];
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

void ReachTable::read(std::vector<Reach>& found) const {
  found.clear();
  for (const Slot& p : slots_) {
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

namespace {

// Intervals that a reach has to last: one until a frame comes that is prepared for it, and one in
// which that frame is felt (docs/method.md 7.5).
constexpr double kFrames = 2;
constexpr double kLatency = 0.03;  // s, from a frame until it is felt (docs/method.md 7.5)

// A hand that rests may start with an acceleration that takes it this far in that time; one that
// moves may double its speed. No hand is faster than the last (judgement; docs/method.md 7.5).
constexpr double kStartSpeed = 0.5;  // m/s
constexpr double kSpeedUp = 2;       // times its speed (judgement)
constexpr double kFastest = 5;       // m/s

// Memory of a speed (judgement).
constexpr double kForget = 0.2;    // s in which a recent speed is forgotten
constexpr double kLongStep = 0.1;  // s; over a longer gap a speed means nothing

}  // namespace

Reach ToolReach::update(double now, const Eigen::Vector3d& hip, const Eigen::Vector3d& proxy,
                        double frame, double margin) noexcept {
  const double dt = now - last_time_;
  if (started_ && dt > 0 && dt < kLongStep) {
    const double speed = std::min((hip - last_hip_).norm() / dt, scale_ * kFastest);
    speed_ = std::max(speed, speed_ * (1 - dt / kForget));
  }
  started_ = true;
  last_time_ = now;
  last_hip_ = hip;
  const double horizon = kFrames * frame + kLatency;
  const double travel = std::max(scale_ * kStartSpeed, kSpeedUp * speed_) * horizon;
  return {0.5 * (hip + proxy), 0.5 * (hip - proxy).norm() + travel + margin};
}

}  // namespace palpate
