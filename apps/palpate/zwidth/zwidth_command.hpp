#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "palpate/device/device.hpp"
#include "palpate/servo/z_width.hpp"

namespace palpate::app {

/// What a map of walls is made for. What is empty is chosen.
struct ZWidthOptions {
  std::string profile = "simulated";  ///< a name that is known
  std::string profiles;               ///< file that has it; empty: what comes with palpate
  std::vector<double> rates;          ///< Hz
  std::vector<int> delays;            ///< steps
  std::vector<double> dampings;       ///< of the device, N s/m
  double wall_damping = 0;            ///< B of the guard's damper, N s/m
  std::string csv;
  std::string json;
  std::string picture;
};

/// How stiff a wall may be on one device at one pace; N/m.
struct ZWidthRow {
  double rate = 0;     ///< Hz
  int delay = 0;       ///< steps
  double damping = 0;  ///< of the device, N s/m
  double colgate = 0;  ///< 2 (b + B) / (T + 2 T_d)
  double stable = 0;   ///< oscillations do not grow
  double passive = 0;  ///< no impact comes out faster than it went in
  double braked = 0;   ///< the same, with the guard's brake
};

struct ZWidthMap {
  DeviceProfile profile;
  double mass = 0;        ///< kg, as simulated
  double resolution = 0;  ///< m
  double coulomb = 0;     ///< N
  double wall_damping = 0;
  std::vector<ZWidthRow> rows;
};

/// Simulates every combination of rate, delay and damping. `progress` is told 0 to 1.
/// @throws Error when there is no such profile or one is out of range.
[[nodiscard]] ZWidthMap measure_zwidth(const ZWidthOptions& options,
                                       const std::function<void(double)>& progress);

/// A table for a person.
void print_zwidth(const ZWidthMap& map, std::FILE* out);

/// A row a wall: rate_Hz, delay_steps, damping_Ns_per_m, ... in N/m.
[[nodiscard]] std::string csv(const ZWidthMap& map);

/// The same as data, and what figures.py is told.
[[nodiscard]] std::string facts(const ZWidthMap& map);

}  // namespace palpate::app

namespace CLI {
class App;
}

namespace palpate::app {

struct StiffnessTestRunOptions {
  std::string device;      ///< what open_device() takes
  bool confirmed = false;  ///< somebody holds the device and knows what comes
  StiffnessTestOptions trial = {};
  std::string json;  ///< file for what was found; "-": standard output; empty: none
};

/// Measures on hardware how stiff a wall may be: tells what comes, asks unless `confirmed`, and
/// leads the hand step by step.
/// @throws UsageError when nobody has confirmed, Error when there is no such device, when it failed
///   or nothing was measured.
void run_stiffness_test(const StiffnessTestRunOptions& options);

struct ZWidthChoices {
  ZWidthOptions map;
  StiffnessTestRunOptions trial;  ///< on hardware, where a device is named
};

void add_zwidth_options(CLI::App& command, ZWidthChoices& choices);

/// Simulates, or measures on hardware, how stiff a wall may be, and tells it as asked.
/// @throws Error, UsageError.
void zwidth(const ZWidthChoices& choices);

}  // namespace palpate::app
