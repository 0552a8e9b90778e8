#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/palpate/report/live_report.hpp"
#include "apps/palpate/run/run.hpp"

namespace palpate::app {

/// Everything that a run's report tells of one hand.
struct HandReport {
  const Hand& hand;
  const TouchStatistics& statistics;
  FieldOptions field;
  double stiffness = 0;                  ///< of the surface as the run began, N/m in the world
  const LiveReport* live = nullptr;      ///< of a run in real time
  const Unguarded* unguarded = nullptr;  ///< of one in simulated time
  bool interrupted = false;              ///< by Ctrl-C
  bool scales = true;                    ///< is there a file, whose units --scale can mend?
};

/// Work done on the hand, J: in its own metres, where the cloud is magnified (workspace.hpp).
struct HandEnergy {
  double given = 0;  ///< TouchStatistics::given_energy()
  double path = 0;   ///< TouchStatistics::path_energy()
};
[[nodiscard]] HandEnergy energy_at_hand(const HandReport& report);

/// What to do differently, in whole sentences; empty: nothing.
[[nodiscard]] std::vector<std::string> advice(const HandReport& report);

/// For a person, under `title`.
void print_hand(const HandReport& report, const std::string& title, std::FILE* stream);

/// The same as data: SI units, named in the keys.
[[nodiscard]] nlohmann::ordered_json json_hand(const HandReport& report);

}  // namespace palpate::app
