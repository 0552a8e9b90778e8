#pragma once

#include "apps/palpate/options/live_options.hpp"
#include "apps/palpate/run/touch_statistics.hpp"
#include "palpate/device/device.hpp"
#include "palpate/servo/guard.hpp"

namespace palpate::app {

/// What a guard would have made of a run that has none: its slew and its clamp, on the way that the
/// hand went without them. Damper and soft start, which change every force a little, are left out.
class Unguarded {
 public:
  /// With the limits that a run in real time would have. `scale` is the workspace's.
  Unguarded(const LiveOptions& options, const DeviceInfo& device, double scale);

  void add(const TouchStep& step);

  [[nodiscard]] const GuardOptions& limits() const { return guard_.options(); }
  /// `slewed` and `clamped` are the steps that would have been slowed and shortened.
  [[nodiscard]] const GuardCounts& counts() const { return guard_.state().counts; }
  /// Largest change of the force, N, in a step that would have been slowed.
  [[nodiscard]] double largest_change() const { return largest_change_; }

 private:
  Guard guard_;
  TouchStep last_;
  double largest_change_ = 0;
};

}  // namespace palpate::app
