#include "apps/palpate/run/unguarded.hpp"

#include <algorithm>
#include <limits>

#include "palpate/servo/servo.hpp"

namespace palpate::app {

namespace {

// Simulated steps may be as far apart as the rows of a trajectory: that is no silence.
GuardOptions limits_for(const LiveOptions& options, const DeviceInfo& device, double scale) {
  GuardOptions limits = guard_for(device, guard_options(options));
  limits.damping = 0;
  limits.soft_start = 0;
  limits.silence = std::numeric_limits<double>::infinity();
  return in_world(limits, scale);
}

}  // namespace

Unguarded::Unguarded(const LiveOptions& options, const DeviceInfo& device, double scale)
    : guard_(limits_for(options, device, scale)) {}

void Unguarded::add(const TouchStep& step) {
  GuardInput input;
  input.force = step.contact.force;
  input.normal = step.contact.normal;
  input.drift = step.contact.drift;
  input.hip = step.hip;
  input.stiffness = step.contact.stiffness;
  input.dt = counts().steps > 0 ? step.time - last_.time : 0;
  static_cast<void>(guard_.pass(input));
  if (has(guard_.state().notes, GuardNote::slewed)) {
    const double change = (step.contact.force - last_.contact.force).norm();
    largest_change_ = std::max(largest_change_, change);
  }
  last_ = step;
}

}  // namespace palpate::app
