// The command zwidth.
#pragma once

#include <string>
#include <vector>

#include "palpate/servo/z_width.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

/// Parameters of a map of walls; empty ones get defaults.
struct ZWidthOptions {
  std::string profile;           ///< a name; empty: simulated, or the only one of `profiles`
  std::string profiles;          ///< file that has it; empty: what comes with palpate
  std::vector<double> rates;     ///< Hz
  std::vector<int> delays;       ///< steps
  std::vector<double> dampings;  ///< of the device, N s/m
  double wall_damping = 0;       ///< B of the guard's damper, N s/m
  std::string csv;
  std::string json;
  std::string picture;
};

struct StiffnessTestRunOptions {
  std::string device;      ///< what open_device() takes
  bool confirmed = false;  ///< somebody holds the device and knows what comes
  StiffnessTestOptions trial = {};
  std::string json;  ///< file for what was found; "-": standard output; empty: none
};

/// Measures on hardware how stiff a wall may be: explains what comes, asks unless `confirmed`, and
/// leads the hand step by step.
/// @throws UsageError when nobody has confirmed, Error when there is no such device, when it failed
///   or nothing was measured.
void run_stiffness_test(const StiffnessTestRunOptions& options);

struct ZWidthChoices {
  ZWidthOptions map;
  StiffnessTestRunOptions trial;  ///< on hardware, where a device is named
};

void add_zwidth_options(CLI::App& command, ZWidthChoices& choices);

/// Simulates, or measures on hardware, how stiff a wall may be, and reports it as requested.
/// @throws Error, UsageError.
void zwidth(const ZWidthChoices& choices);

}  // namespace palpate::app
