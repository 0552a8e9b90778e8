#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/palpate/report/report.hpp"
#include "apps/palpate/run/measured_forces.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/run/touch_statistics.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {

/// Timing, guard and failures of one hand in a run in real time.
struct LiveReport {
  RealtimeReport realtime;
  double rate = 0;  ///< steps a second that were wanted, Hz
  Durations lateness;
  std::uint64_t skipped = 0;    ///< steps left out because one before them was late
  std::uint64_t unwritten = 0;  ///< steps that came faster than they could be written down
  GuardOptions limits;          ///< of the guard, as they held
  Guard::State guard;           ///< at the end
  std::string failure;          ///< of the device, in words; empty: none
};

/// Everything that a run's report contains of one hand.
struct HandReport {
  const Hand& hand;
  const TouchStatistics& statistics;
  FieldOptions field;
  double stiffness = 0;                      ///< of the surface as the run began, N/m in the world
  const LiveReport* live = nullptr;          ///< of a run in real time
  const Unguarded* unguarded = nullptr;      ///< of one in simulated time
  bool interrupted = false;                  ///< by Ctrl-C
  bool scales = true;                        ///< is there a file, whose units --scale can mend?
  bool surface = true;                       ///< is there a source with one?
  std::string unlogged = {};                 ///< why its log is not whole; empty: it is
  const MeasuredForces* compared = nullptr;  ///< that its trajectory holds; null: not compared
};

/// Work done on the hand, J: in its own metres, where the cloud is magnified (Workspace).
struct HandEnergy {
  double given = 0;  ///< TouchStatistics::given_energy()
  double path = 0;   ///< TouchStatistics::path_energy()
};
[[nodiscard]] HandEnergy energy_at_hand(const HandReport& report);

/// Advice in whole sentences; may be empty.
[[nodiscard]] std::vector<std::string> advice(const HandReport& report);

/// A hand's part of the report, under `title`.
[[nodiscard]] Report report_of(const HandReport& hand, const std::string& title);

}  // namespace palpate::app
