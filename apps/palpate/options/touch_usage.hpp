#pragma once

#include "apps/palpate/options/touch_options.hpp"
#include "palpate/io/trajectory.hpp"

namespace palpate::app {

/// What can be told of a command line before anything is read.
/// @throws UsageError when options contradict each other, or would change nothing.
void check_usage(const TouchOptions& options);

/// Does the run go on in the time of day? What stands still has no need of it.
[[nodiscard]] bool in_real_time(const TouchOptions& options);

/// Is there a page on which the run is seen, and its tool taken?
[[nodiscard]] bool has_page(const TouchOptions& options);

/// Of the trajectory that `options` name. @throws UsageError when it lasts longer than a day and is
/// to be simulated; Error when a place is farther from the origin than surfaces can be felt.
void check_trajectory(const TouchOptions& options, const Trajectory& trajectory);

}  // namespace palpate::app
