// Says what a source's raw frames show, and for how long.
#include <algorithm>
#include <cmath>
#include <limits>

#include "depth/input.hpp"
#include "scene/source_inside.hpp"
#include "sight/sight.hpp"

namespace palpate {
namespace {

// Mean intervals that a frame lasts while it is not known when frames are due: two may be lost. As
// many periods of its device stop a servo (guard_for()).
constexpr double kMissedFrames = 2.5;

}  // namespace

/// Lets the frame say which places are free.
void Source::Inside::show(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor) {
  depth::check(frame);
  if (!std::isfinite(frame.stamp)) return;
  const NoiseModel& noise = builder->noise();
  sight.see(frame, T_world_sensor, noise.sigma(1) > 0 ? noise : unknown_sensor_noise());
}

/// The ages up to which a frame can say what is free.
FrameLimits Source::Inside::frame_limits() const {
  constexpr double kEver = std::numeric_limits<double>::infinity();  // s: a file does not age
  if (stays) return {.at_first = kEver, .later = kEver};
  const std::lock_guard lock(mutex);
  const double silence = options.policy.silence;
  const double latency = std::min(state.latency, silence);
  const double missed = state.interval > 0 ? kMissedFrames * state.interval : silence;
  return {.at_first = latency + std::min(missed, silence), .later = latency + silence};
}

std::optional<Seen> Source::seen(const Ball& ball, double now) const {
  inside_->watched = true;
  std::optional<Seen> seen = inside_->sight.at(ball, now, inside_->frame_limits());
  if (!seen && state().depth > 0) seen.emplace();  // a camera whose frames were not kept before
  return seen;
}

}  // namespace palpate
