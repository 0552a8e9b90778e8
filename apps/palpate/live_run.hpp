#pragma once

#include "apps/palpate/run.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/histogram.hpp"
#include "palpate/servo/realtime.hpp"
#include "palpate/base/waiting_clock.hpp"

namespace palpate::app {

/// What a run in real time was like.
struct LiveReport {
  RealtimeReport realtime;
  double rate = 0;  ///< steps a second that were wanted, Hz
  Durations lateness;
  std::uint64_t skipped = 0;    ///< steps left out because one before them was late
  std::uint64_t unwritten = 0;  ///< steps that came faster than they could be written down
  GuardOptions limits;          ///< of the guard, as they held
  GuardState guard;             ///< at the end
  bool interrupted = false;     ///< by Ctrl-C
};

/// Cameras, preparation and servo on threads of their own, in the time of `clock`, on which the
/// cameras were opened. Recordings begin together when the run does, at its time 0, and the hand at
/// once after them. Shows on standard error how it goes. Ends with the hand's way, or when it is
/// interrupted. Hands every step to `each`, on the calling thread, with the force that was felt and
/// times from 0. Fills in what `touched` tells of its cameras.
/// @throws Error when the device fails, a recording cannot begin, or there are no threads to be
/// had.
LiveReport run_live(Run& run, WaitingClock& clock, const EachStep& each);

}  // namespace palpate::app
