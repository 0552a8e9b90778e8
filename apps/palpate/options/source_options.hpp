#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace palpate::app {

/// How the bytes of a file become points.
struct ReadingOptions {
  double scale = 1;          ///< file's coordinates to metres
  std::string intrinsics;    ///< "fx,fy,cx,cy"; empty: none
  double depth_unit = 1e-3;  ///< m
};

/// How one source is read and treated: the same for all, but for what a set-up file says of one.
/// What is not set is chosen from the data.
struct SourceChoices {
  ReadingOptions reading;
  std::string viewpoint;
  bool unorganised = false;  ///< depth images and organised clouds as loose points
  std::optional<double> radius;
  std::optional<double> voxel;
  std::string policy;
  std::optional<int> history;
  std::optional<double> silence;       ///< s
  std::optional<double> fade;          ///< s
  std::string noise;                   ///< "s0,s1,s2[,correlation]"; empty: measured
  std::optional<double> nearest;       ///< depth, m
  std::optional<double> farthest;      ///< depth, m
  std::optional<int> memory;           ///< frames
  std::optional<double> normal_error;  ///< rad
  bool fit_everywhere = false;
  bool clip_to_reach = false;
  bool loop = false;
};

/// Options that a set-up file has, as "--noise", each with the words for where: "desk.toml, line 3:
/// 'noise'".
using DescribedOptions = std::map<std::string, std::string, std::less<>>;

/// A source as a set-up file has it.
struct SourceSetup {
  std::string name;  ///< empty: after `from`
  std::string from;  ///< as on the command line, without NAME=
  std::optional<Eigen::Isometry3d> pose;
  SourceChoices choices;
  DescribedOptions described;  ///< that it has itself
};

/// Adds the options that say how the bytes of a file become points.
void add_reading_options(CLI::App& command, ReadingOptions& options);

/// Adds the options of the command line.
void add_source_options(CLI::App& command, SourceChoices& choices);

/// Adds those that a set-up file alone has.
void add_source_setup_options(CLI::App& file, SourceChoices& choices);

/// What a command takes as sources, for its help.
[[nodiscard]] std::string cloud_help();

}  // namespace palpate::app
