// The command info, and what it finds out.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "apps/palpate/options/tool_options.hpp"
#include "apps/palpate/report/source_report.hpp"
#include "apps/palpate/sources/cloud_facts.hpp"
#include "apps/palpate/sources/load.hpp"
#include "palpate/depth/depth_frame.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/scene/source.hpp"
#include "session/length_unit.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate info`.
struct InfoOptions {
  std::vector<std::string> clouds;
  ToolPlan tool;
  FileReading reading;
  std::string json;
  std::string picture;  ///< of several clouds the first one's: numbered_path()
  std::string write;    ///< points as PLY or PCD; of several clouds the first one's, too
};

void add_info_options(CLI::App& command, InfoOptions& options);

/// `palpate info`. @throws UsageError, Error.
void info(const InfoOptions& options);

/// A cloud without outliers seen along its shortest side, as counts on a grid.
struct DensityMap {
  int columns = 0;
  int rows = 0;
  int horizontal = 0;               ///< axis (0-2) that runs to the right
  int vertical = 0;                 ///< axis that runs upwards
  double cell = 0;                  ///< width of a cell, m; it is twice as high, like a letter
  std::vector<std::size_t> counts;  ///< row by row, the top one first

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
};

[[nodiscard]] DensityMap map_density(const PointCloud& cloud, int columns);

/// The map as lines of text, denser is darker; in colours when `colored`.
[[nodiscard]] std::string draw(const DensityMap& map, bool colored);

/// Everything that `palpate info` reports of one cloud: what is measured at once, and what a study
/// adds.
struct InfoReport {
  LoadedCloud loaded;
  Box bounds;
  Box core;  ///< without outliers
  session::UnitsGuess units;
  OrganisedFrame organised;  ///< of a cloud with rows and columns
  Source::State image;       ///< felt as that frame; depth 0: it is not
  double image_radius = 0;   ///< R then, median, m

  double nearest_three = 0;   ///< distance of points to their three nearest, m
  Prepared::Report prepared;  ///< with the defaults: the advice
  double rim = 0;             ///< share of points at a border or a hole
};

/// What is measured at once: points, bounds, units.
[[nodiscard]] Report report_of(const InfoReport& report);

/// Adds what a study found.
void add_study(Report& report, const InfoReport& info);

/// R of what touch() would feel of it, m.
[[nodiscard]] inline double felt_radius(const InfoReport& report) {
  return report.image.depth > 0 ? report.image_radius : report.prepared.radius;
}

/// Prints what a tool is on a surface whose support radius is `radius` (m; 0: it is unknown), and
/// adds it to the data of `report`. @throws Error as NamedTool does.
void report_tool(Report& report, const ToolPlan& tool, double radius, std::FILE* out);

/// What touch() would do by default, in the words of its options.
[[nodiscard]] Report advice_of(const InfoReport& report);

/// What some frames of a camera or sequence show of it.
struct LiveFacts {
  CloudArgument argument;
  std::string assumed;  ///< CameraInfo::assumed
  int width = 0;        ///< pixels
  int height = 0;       ///< pixels
  Pinhole pinhole;
  bool distorted = false;
  bool posed = false;        ///< frames store where they were taken
  std::size_t frames = 0;    ///< that were looked at
  std::size_t repeated = 0;  ///< of them bit for bit like the one before
  std::size_t failures = 0;  ///< reads that failed
  std::size_t unposed = 0;   ///< frames without a pose among those with one
  double rate = 0;           ///< frames a second by their stamps, Hz
  double valid = 0;          ///< share of pixels with a depth
  double depth = 0;          ///< median, m
  double nearest = 0;        ///< a hundredth of the depths is nearer, m
  double farthest = 0;       ///< a hundredth is farther, m
  NoiseModel noise;          ///< as measured
  bool clouds = false;       ///< frames are clouds
  std::size_t points = 0;    ///< of the first of these
  double spacing = 0;        ///< between them, m
};

/// Looks at the first 30 frames, or as many as there are. @throws Error when there is none.
[[nodiscard]] LiveFacts study_live(const CloudArgument& argument);

[[nodiscard]] Report report_of(const LiveFacts& facts);

}  // namespace palpate::app
