#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "apps/palpate/options/live_options.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "apps/palpate/options/view_options.hpp"

namespace palpate::app {

/// Options that a command line has, as "--rate".
using GivenOptions = std::set<std::string, std::less<>>;

/// The command line of `palpate touch`. Lengths in metres; what is not set is chosen from the data.
struct TouchOptions {
  GivenOptions given;               ///< that the command line itself has
  DescribedOptions described;       ///< that the set-up file has for every source
  std::vector<std::string> clouds;  ///< sources of the command line
  std::string setup;                ///< file that describes a set-up
  std::vector<SourceSetup> setup_sources;
  std::vector<std::string> poses;
  SourceChoices choices;  ///< of every source that the set-up file says nothing else of

  std::string preset = "default";
  std::string field;
  std::string kernel;
  std::string gradient;
  std::optional<double> threshold;
  double tool_radius = 0;
  bool sharp_edges = true;

  std::optional<double> stiffness;        ///< N/m
  std::optional<double> friction_static;  ///< the dynamic one unless given
  double friction_dynamic = 0;
  double friction_viscous = 0;           ///< N s/m
  double texture_amplitude = 0;          ///< m
  double texture_wavelength = 4e-3;      ///< m
  std::optional<double> soft_stiffness;  ///< N/m
  std::optional<double> soft_friction;   ///< share, 0 to 1

  std::string trajectory;
  std::vector<std::string> devices;  ///< one a hand, as parse_device() takes them
  std::optional<double> duration;    ///< s
  std::optional<std::uint64_t> seed;
  std::optional<double> rate;  ///< steps a second, Hz

  bool simulated_time = false;
  std::optional<double> latency;  ///< from stamp to touchable in simulated time, s
  LiveOptions live;
  ViewOptions view;

  std::string log;
  std::string json;
  std::string picture;
};

/// Adds those that say which sources there are, how they are read and where they stand.
void add_placed_sources(CLI::App& command, TouchOptions& options);

/// Adds every option of `palpate touch`.
void add_touch_options(CLI::App& command, TouchOptions& options);

/// Adds those that a set-up file alone has.
void add_setup_options(CLI::App& file, TouchOptions& options);

}  // namespace palpate::app
