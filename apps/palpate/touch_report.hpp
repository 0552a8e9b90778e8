#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/palpate/exploration_plan.hpp"
#include "apps/palpate/live_run.hpp"
#include "apps/palpate/touch_statistics.hpp"
#include "apps/palpate/touched.hpp"
#include "palpate/contact/proxy.hpp"

namespace palpate::app {

/// Everything that a run's report tells.
struct TouchReport {
  const Touched& touched;
  const Scene& felt;  ///< as the run left it
  const TouchOptions& options;
  const TouchStatistics& statistics;
  FieldOptions field;
  ProxyOptions proxy;
  std::string device;                     ///< its name
  const ExplorationPlan* plan = nullptr;  ///< of the built-in exploration, if it was that
  const LiveReport* live = nullptr;       ///< of a run in real time
  bool interrupted = false;               ///< by Ctrl-C
};

/// Work done on the hand, J: in its own metres, where the cloud is magnified (workspace.hpp).
struct HandEnergy {
  double given = 0;  ///< TouchStatistics::given_energy()
  double path = 0;   ///< TouchStatistics::path_energy()
};
[[nodiscard]] HandEnergy energy_at_hand(const TouchReport& report);

/// What to do differently, in whole sentences; empty: nothing.
[[nodiscard]] std::vector<std::string> advice(const TouchReport& report);

/// For a person.
void print_report(const TouchReport& report, std::FILE* stream);

/// The same as data: SI units, named in the keys.
[[nodiscard]] nlohmann::ordered_json json_report(const TouchReport& report);

}  // namespace palpate::app
