// Says what a source's raw frames show, and for how long.
#include <algorithm>
#include <cmath>
#include <limits>

#include "depth/input.hpp"
#include "scene/sight.hpp"
#include "scene/source_inside.hpp"

namespace palpate {

/// Lets the frame say which places are free.
void Source::Inside::show(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor) {
  depth::check(frame);
  if (!std::isfinite(frame.stamp)) return;
  const NoiseModel& noise = builder->noise();
  sight.see(frame, T_world_sensor, noise.sigma(1) > 0 ? noise : unknown_sensor_noise());
}

/// The age up to which a frame can say what is free at most, s.
double Source::Inside::lasts_at_most() const {
  if (stays) return std::numeric_limits<double>::infinity();
  const std::lock_guard lock(mutex);
  const double silence = options.policy.silence;
  return std::min(state.latency, silence) + silence;
}

std::optional<Seen> Source::seen(const Ball& ball, double now) const {
  inside_->watched = true;
  std::optional<Seen> seen = inside_->sight.at(ball, now, inside_->lasts_at_most());
  if (!seen && state().depth > 0) seen.emplace();  // a camera whose frames were not kept before
  return seen;
}

}  // namespace palpate
