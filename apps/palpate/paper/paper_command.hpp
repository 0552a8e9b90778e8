// The command paper, and the results of its figures.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "palpate/sensor/depth_camera.hpp"

namespace CLI {
class App;
}

namespace palpate::app {

/// The command line of `palpate paper FIGURE`.
struct PaperOptions {
  std::string source;  ///< camera or sequence
  std::string csv;
  std::string picture;
  int repeats = 5;               ///< of each measurement of fig5; the fastest counts
  double duration = 4;           ///< of the press of fig7, s
  std::optional<double> radius;  ///< R of the paper's clouds in fig7, m
  std::optional<double> voxel;   ///< of the paper's clouds in fig7, m
};

/// The figures of `palpate paper`, each a command of its own.
struct PaperCommand {
  PaperOptions options;
  CLI::App* fig5 = nullptr;
  CLI::App* fig7 = nullptr;
};

void add_paper_options(CLI::App& command, PaperCommand& paper);

/// `palpate paper`. @throws UsageError, Error.
void paper(const PaperCommand& paper);

/// The three steps of preparation that the paper timed, ms.
struct PrepareTimes {
  double index = 0;  ///< the paper's kd-tree
  double normals = 0;
  double spacing = 0;

  [[nodiscard]] double sum() const { return index + normals + spacing; }
};

/// One size of cloud.
struct Fig5Row {
  std::size_t points = 0;       ///< that the paper had
  std::size_t points_here = 0;  ///< as near as a voxel filter comes to it
  double voxel = 0;             ///< its leaf, m
  PrepareTimes paper;           ///< on a Core i7-950
  PrepareTimes here;            ///< wall time on all cores, the fastest
  double weights = 0;           ///< what we do besides: radii and density weights, ms
};

struct Fig5 {
  std::vector<Fig5Row> rows;
  std::size_t pixels = 0;  ///< of the frame, with a depth
  double everywhere = 0;   ///< from a frame to a surface by the depth filter, computing time of
                           ///< all threads, the fastest, ms
};

/// Prepares the points of the camera's first frame at the paper's four sizes, `repeats` times each,
/// and as many of its frames as our depth streams do.
/// @throws Error when the frame has fewer points than the paper's largest cloud, or the camera
/// gives none.
[[nodiscard]] Fig5 measure_fig5(DepthCamera& camera, int repeats);

/// One moment of a press, in the frame of the surface.
struct PressSample {
  double height = 0;  ///< of the proxy over its mean, along the surface's normal, m
  double nx = 0;      ///< tangential components of the field's normal at the proxy
  double ny = 0;
  double force = 0;  ///< N
};

/// One method of feeling the surface.
struct Press {
  std::string name;   ///< "metaball", "point-set", "palpate"
  int clouds = 0;     ///< N; 0: our default, which keeps no clouds
  double radius = 0;  ///< R at the test point (median), m
  std::vector<PressSample> samples;

  // Over the samples:
  double height_sd = 0;  ///< m
  double nx_sd = 0;      ///< rad
  double ny_sd = 0;      ///< rad
  double jump = 0;       ///< largest change of the force from one servo step to the next, N
  double touching = 0;   ///< share of steps
};

struct Fig7 {
  std::vector<Press> presses;
  std::vector<double> times;  ///< of the samples, s
  double depth = 0;           ///< of the test point, along the optical axis, m
  double angle = 0;           ///< between optical axis and surface, rad
  double voxel = 0;           ///< of the paper's clouds, m
  bool radius_given = false;
  std::size_t frames = 0;
};

struct Fig7Options {
  double duration = 4;                ///< of the press, s
  double voxel = 4e-3;                ///< of the paper's clouds, m
  std::optional<double> radius = {};  ///< R of the paper's clouds, m; unset: 2.5 s
};

/// The paper's test of stability over time: a hand held 4 mm deep in the surface in the middle of
/// the image, felt by nine methods at once, from the same frames.
/// @throws Error when the camera ends or fails before the press does.
[[nodiscard]] Fig7 measure_fig7(DepthCamera& camera, const Fig7Options& options);

}  // namespace palpate::app
