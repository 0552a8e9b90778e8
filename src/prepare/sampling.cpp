// Chooses which points are kept and measures their spacing and noise.

#include "prepare/sampling.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "palpate/geometry/spacing.hpp"
#include "prepare/lines.hpp"
#include "prepare/stopwatch.hpp"

namespace palpate {
namespace {

// Noise against spacing, above which a cloud is thinned to two spacings; judgement.
constexpr double kNoisy = 0.25;
constexpr double kLeafSpacings = 2;  // edge of a voxel of a noisy cloud; judgement

}  // namespace

std::vector<std::uint32_t> distinct_points(const CellGrid& grid) {
  std::vector<std::uint8_t> later(grid.size());  // 1: another one stands there before it
  std::vector<Eigen::Vector3f> positions;        // of the cell; all points may share one
  for (const CellGrid::Cell& cell : grid.cells()) {
    if (cell.children > 0) continue;
    positions.clear();
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      const Eigen::Vector3f& position = grid.points()[i];
      const bool repeated = std::ranges::find(positions, position) != positions.end();
      later[grid.order()[i]] = repeated ? 1 : 0;
      if (!repeated) positions.push_back(position);
    }
  }
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < later.size(); ++i) {
    if (later[i] == 0) first.push_back(i);
  }
  return first;
}

namespace {

/// @return spacings of lines; empty where the cloud is not of lines
std::vector<float> measure_spacings(const PrepareOptions& options, Sampling& sampling) {
  const CellGrid& grid = sampling.grid;
  CloudFacts& facts = sampling.facts;
  std::vector<float> of_lines;
  sampling.spacings = local_spacings(grid);
  if (!options.paper && !options.radius) {
    if (!options.facts) facts.in_lines = lies_in_lines(grid);
    if (facts.in_lines) of_lines = spacings_of_lines(grid);
    widen_to_lines(of_lines, sampling.spacings);
  }
  sampling.spacing = options.facts ? facts.spacing : median(sampling.spacings);
  return of_lines;
}

/// Measures the noise of all points where no facts are given.
void measure_noise_of_all(const PrepareOptions& options, std::span<const float> of_lines,
                          Sampling& sampling) {
  if (options.facts || options.paper) return;
  // A window that holds one line alone fits it, however noisy it is.
  std::vector<float> windows(sampling.spacings.size(), static_cast<float>(sampling.spacing));
  for (std::size_t i = 0; i < of_lines.size(); ++i) {
    if (of_lines[i] > 0) windows[i] = of_lines[i];
  }
  sampling.facts.noise = measure_noise(sampling.grid, sampling.spacing, windows);
}

bool is_noisy(const CloudFacts& facts) {
  return facts.noise.sigma > kNoisy * facts.spacing;
}

/// Leaves the points at positions of their own.
void drop_duplicates(PointCloud& less, const PointCloud*& cloud, Sampling& sampling) {
  const auto distinct = distinct_points(sampling.grid);
  if (distinct.size() == cloud->size()) return;
  less = select(*cloud, distinct);
  cloud = &less;
  sampling.grid = CellGrid(less.positions);
}

/// Raises spacings to the voxel's edge: on a slanted surface centroids stand closer than that.
void raise_to_voxel(Sampling& sampling) {
  const auto leaf = static_cast<float>(sampling.voxel);
  for (float& s : sampling.spacings) s = std::max(s, leaf);
  sampling.spacing = std::max(sampling.spacing, sampling.voxel);
}

/// Replaces the points of each voxel by their mean.
void thin(const PrepareOptions& options, PointCloud& less, const PointCloud*& cloud,
          Sampling& sampling, Prepared::Report& report) {
  Stopwatch watch;
  std::optional<NoiseMap> map;
  if (is_noisy(sampling.facts) && !options.radius) map.emplace(sampling.grid, sampling.spacings);
  watch.lap(report.seconds_spacing);
  std::vector<std::uint32_t> counts;
  less = voxel_downsample(*cloud, sampling.voxel, &counts);
  cloud = &less;
  watch.lap(report.seconds_filter);
  sampling.grid = CellGrid(less.positions);
  sampling.counts = in_grid_order(sampling.grid, counts);
  watch.lap(report.seconds_index);
  measure_spacings(options, sampling);
  raise_to_voxel(sampling);
  if (map) sampling.local = map->at(sampling.grid.points(), sampling.facts.noise);
  watch.lap(report.seconds_spacing);
}

/// The tight box of the points, world frame, m.
Box box_of(const Sampling& sampling) {
  const CellGrid::Cell& root = sampling.grid.cells().front();
  return {sampling.origin + root.lower.cast<double>(), sampling.origin + root.upper.cast<double>()};
}

/// The columns that came with the points.
void take_columns(const PointCloud& cloud, const PrepareOptions& options, Sampling& sampling) {
  sampling.normals = in_grid_order(sampling.grid, cloud.normals);
  sampling.colors = in_grid_order(sampling.grid, cloud.colors);
  if (options.material_from_intensity) {
    sampling.intensities = in_grid_order(sampling.grid, cloud.intensities);
  }
}

}  // namespace

double voxel_of(const CloudFacts& facts, const PrepareOptions& options) {
  return options.voxel.value_or(is_noisy(facts) ? kLeafSpacings * facts.spacing : 0);
}

Sampling sample(const Placed& placed, const PrepareOptions& options, Prepared::Report& report) {
  Stopwatch watch;
  Sampling sampling;
  sampling.facts = options.facts.value_or(CloudFacts{});
  PointCloud less;
  const PointCloud* cloud = &placed.cloud();
  sampling.origin = cloud->origin;
  sampling.grid = CellGrid(cloud->positions);
  if (!options.paper) drop_duplicates(less, cloud, sampling);
  report.duplicates = placed.cloud().size() - cloud->size();
  watch.lap(report.seconds_index);
  const std::vector<float> of_lines = measure_spacings(options, sampling);
  CloudFacts& facts = sampling.facts;
  if (!options.facts) facts.spacing = sampling.spacing;
  measure_noise_of_all(options, of_lines, sampling);
  sampling.voxel = voxel_of(facts, options);
  watch.lap(report.seconds_spacing);
  if (sampling.voxel > 0) thin(options, less, cloud, sampling, report);
  if (sampling.local.sigmas.empty()) {
    sampling.local.sigmas.assign(sampling.grid.size(), static_cast<float>(facts.noise.sigma));
  }
  if (!options.facts) facts.extent = box_of(sampling);
  if (options.paper && !options.radius) sampling.spacing = mean_spacing(sampling.grid);
  take_columns(*cloud, options, sampling);
  report.spacing = sampling.spacing;
  report.noise = facts.noise.sigma;
  report.voxel = sampling.voxel;
  return sampling;
}

}  // namespace palpate
