#include "scene/tool_reach.hpp"

#include <algorithm>

namespace palpate {
namespace {

// A frame is felt for one interval, and the one before it was prepared; and so long it takes until
// it can be felt.
constexpr double kFrames = 2;
constexpr double kLatency = 0.03;  // s

// A hand that rests may start with an acceleration that takes it this far in that time; one that
// moves may double its speed. No hand is faster than the last.
constexpr double kStartSpeed = 0.5;  // m/s
constexpr double kSpeedUp = 2;
constexpr double kFastest = 5;  // m/s

constexpr double kForget = 0.2;    // s in which a speed of late is forgotten
constexpr double kLongStep = 0.1;  // s; over a longer gap a speed says nothing

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
  const double way = std::max(scale_ * kStartSpeed, kSpeedUp * speed_) * horizon;
  return {0.5 * (hip + proxy), 0.5 * (hip - proxy).norm() + way + margin};
}

}  // namespace palpate
