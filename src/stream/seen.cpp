// Decides what a source's raw frames show, and for how long.
#include <algorithm>
#include <cmath>
#include <limits>

#include "depth/input.hpp"
#include "stream/streaming.hpp"

namespace palpate {
namespace {

// Mean intervals that a frame lasts while it is unknown when frames are due: two may be lost. As
// many periods of its device stop a servo (guard_for()).
constexpr double kMissedFrames = 2.5;

}  // namespace

void Streaming::show(const DepthFrame& frame, const Eigen::Isometry3d& T_world_sensor) {
  depth::check(frame);
  if (!std::isfinite(frame.stamp)) return;
  const NoiseModel& noise = builder->noise();
  sight.see(frame, T_world_sensor, noise.sigma(1) > 0 ? noise : unknown_sensor_noise());
}

FrameLimits Streaming::frame_limits(const Source::Inside& source) const {
  constexpr double kEver = std::numeric_limits<double>::infinity();  // s: a file does not age
  if (stays) return {.at_first = kEver, .later = kEver};
  const std::lock_guard lock(source.mutex);
  const Source::State& state = source.state;
  const double silence = source.options.policy.silence;
  const double latency = std::min(state.latency, silence);
  const double missed = state.interval > 0 ? kMissedFrames * state.interval : silence;
  return {.at_first = latency + std::min(missed, silence), .later = latency + silence};
}

std::optional<Seen> Source::seen(std::span<const Ball> balls, double now) const {
  Streaming& streaming = *inside_->streaming;
  streaming.watched = true;
  std::optional<Seen> seen = streaming.sight.at(balls, now, streaming.frame_limits(*inside_));
  if (!seen && state().depth > 0) seen.emplace();  // a camera whose frames were not kept before
  return seen;
}

}  // namespace palpate
