#pragma once

#include <vector>

#include "apps/palpate/report/hand_report.hpp"
#include "apps/palpate/run/run.hpp"
#include "palpate/base/clock.hpp"

namespace palpate::app {

/// How a run in real time went.
struct LiveOutcome {
  std::vector<LiveReport> hands;
  bool interrupted = false;  ///< by Ctrl-C
};

/// Cameras, preparation and the servo of each hand on threads of their own, in the time of `clock`,
/// on which the cameras were opened. Recordings begin together when the run does, at its time 0,
/// and the hands at once after them. Shows on standard error how it goes. Ends when every hand has
/// come to its end, or when it is interrupted; a device that fails ends its own hand alone, which
/// is said at once. Hands every step to `each`, on the calling thread, with times from 0. Fills in
/// what `loaded` tells of its cameras.
/// @throws Error when a recording cannot begin, or there are no threads to be had.
LiveOutcome run_live(Run& run, WaitingClock& clock, const EachStep& each);

}  // namespace palpate::app
