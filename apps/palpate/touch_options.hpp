#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace palpate::app {

/// How clouds are read; the same for every command.
struct LoadOptions {
  std::vector<std::string> clouds;
  double scale = 1;          ///< file's coordinates to metres
  std::string intrinsics;    ///< "fx,fy,cx,cy"; empty: none
  double depth_unit = 1e-3;  ///< m
};

/// The command line of `palpate touch`. Lengths in metres; what is not set is chosen from the data.
struct TouchOptions {
  LoadOptions load;
  std::string viewpoint;
  std::vector<std::string> poses;

  std::string preset = "default";
  std::string field;
  std::string kernel;
  std::string gradient;
  std::optional<double> radius;
  std::optional<double> threshold;
  std::optional<double> voxel;
  double tool_radius = 0;
  bool one_sided = false;

  std::optional<double> stiffness;        ///< N/m
  std::optional<double> friction_static;  ///< the dynamic one unless given
  double friction_dynamic = 0;
  double friction_viscous = 0;           ///< N s/m
  double texture_amplitude = 0;          ///< m
  double texture_wavelength = 4e-3;      ///< m
  std::optional<double> soft_stiffness;  ///< N/m
  std::optional<double> soft_friction;   ///< share, 0 to 1

  std::string trajectory;
  std::string device;
  std::optional<double> duration;  ///< s
  std::optional<std::uint64_t> seed;

  std::string log;
  std::string json;
  std::string picture;
};

/// Adds the options that name clouds and say how to read them.
void add_load_options(CLI::App& command, LoadOptions& options);

/// Adds every option of `palpate touch`.
void add_touch_options(CLI::App& command, TouchOptions& options);

}  // namespace palpate::app
