#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "apps/palpate/options/touch_plan.hpp"
#include "apps/palpate/report/hand_report.hpp"
#include "apps/palpate/run/run.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/ros/bridge.hpp"

namespace palpate::app {

/// `palpate touch`: runs as planned and reports; then does the same with what a page opened.
/// @throws UsageError, Error.
void touch(const TouchPlan& plan);

struct DemoOptions {
  std::string scene = "desk";
  TouchChoices touch = {};  ///< but for its sources
};

void add_demo_options(CLI::App& command, DemoOptions& options);

/// Shows a scene that palpate makes itself on its page, explored by simulated hands, one by
/// default, until somebody takes the tool. `command` is what was parsed into `options`.
/// @throws Error as touch() does.
void demo(const CLI::App& command, const DemoOptions& options);

/// Cameras, preparation and servo on one simulated clock, one thread, as fast as they go. The same
/// run gives the same steps, bit for bit. One hand, without a guard. Fills in the facts
/// of cameras in `loaded`. False: it was ended by Ctrl-C. @throws Error when the device fails.
bool run_simulated(Run& run, const EachStep& each);

/// How a run in real time went.
struct LiveOutcome {
  std::vector<LiveReport> hands;
  std::optional<RosBridge::RobotState> robot;  ///< at the end
  bool interrupted = false;                    ///< by Ctrl-C
  /// Where the page of the next run is; unset: there is none.
  std::optional<PagePlan> next_page;
};

/// Cameras, preparation and the servo of each hand on threads of their own, in the time of `clock`,
/// on which the cameras were opened. Recordings begin together when the run does, at its time 0,
/// and the hands at once after them. Shows on standard error how it goes. Ends when every hand has
/// come to its end, or when it is interrupted; a device that fails ends its own hand alone, which
/// is reported at once. Hands every step to `each`, on the calling thread, with times from 0, and
/// reports what that throws. Fills in the facts of cameras in `loaded`.
/// @throws Error when a recording cannot begin, or there are no threads to be had.
LiveOutcome run_live(Run& run, WaitingClock& clock, const Interruption& interruption,
                     const EachStep& each);

}  // namespace palpate::app
