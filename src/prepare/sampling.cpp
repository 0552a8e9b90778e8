// Chooses which points are kept and measures their spacing and noise.

#include "prepare/sampling.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "palpate/geometry/spacing.hpp"
#include "prepare/lines.hpp"
#include "prepare/stopwatch.hpp"

namespace palpate {
namespace {

// Noise against spacing, above which a cloud is thinned to two spacings; judgement.
constexpr double kNoisy = 0.25;
constexpr double kLeafSpacings = 2;  // edge of a voxel of a noisy cloud; judgement

/// Indices of the first point at each position, in input order.
std::vector<std::uint32_t> first_of_each_place(const CellGrid& grid) {
  std::vector<std::uint8_t> later(grid.size());  // 1: another one stands there before it
  for (const CellGrid::Cell& cell : grid.cells()) {
    if (cell.children > 0) continue;
    const auto points = grid.points().subspan(cell.begin, cell.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto before = points.first(k);
      const bool repeated = std::ranges::find(before, points[k]) != before.end();
      later[grid.order()[cell.begin + k]] = repeated ? 1 : 0;
    }
  }
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < later.size(); ++i) {
    if (later[i] == 0) first.push_back(i);
  }
  return first;
}

void measure_spacings(const PrepareOptions& options, Sampling& sampling) {
  sampling.spacings = local_spacings(sampling.grid);
  if (!options.paper && !options.radius) widen_to_lines(sampling.grid, sampling.spacings);
  sampling.spacing = median(sampling.spacings);
}

/// Leaves the points at positions of their own.
void drop_duplicates(PointCloud& less, const PointCloud*& cloud, Sampling& sampling) {
  const auto distinct = first_of_each_place(sampling.grid);
  if (distinct.size() == cloud->size()) return;
  less = select(*cloud, distinct);
  cloud = &less;
  sampling.grid = CellGrid(less.positions);
}

/// Centroids stand closer than their voxels on a slanted surface; s is the voxel.
void raise_to_voxel(Sampling& sampling) {
  const auto leaf = static_cast<float>(sampling.voxel);
  for (float& s : sampling.spacings) s = std::max(s, leaf);
  sampling.spacing = std::max(sampling.spacing, sampling.voxel);
}

/// Replaces the points of each voxel by their mean.
void thin(const Noise& noise, const PrepareOptions& options, PointCloud& less,
          const PointCloud*& cloud, Sampling& sampling, Prepared::Report& report) {
  Stopwatch watch;
  std::optional<NoiseMap> map;
  const bool noisy = noise.sigma > kNoisy * sampling.footprint;
  if (noisy && !options.radius) map.emplace(sampling.grid, sampling.spacings);
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
  if (map) sampling.local = map->at(sampling.grid.points(), noise);
  watch.lap(report.seconds_spacing);
}

/// The columns that came with the points.
void take_columns(const PointCloud& cloud, const PrepareOptions& options, Sampling& sampling) {
  sampling.origin = cloud.origin;
  sampling.normals = in_grid_order(sampling.grid, cloud.normals);
  sampling.colors = in_grid_order(sampling.grid, cloud.colors);
  if (options.material_from_intensity) {
    sampling.intensities = in_grid_order(sampling.grid, cloud.intensities);
  }
}

}  // namespace

Sampling sample(const Placed& placed, const PrepareOptions& options, Prepared::Report& report) {
  Stopwatch watch;
  Sampling sampling;
  PointCloud less;
  const PointCloud* cloud = &placed.cloud();
  sampling.grid = CellGrid(cloud->positions);
  if (!options.paper) drop_duplicates(less, cloud, sampling);
  report.duplicates = placed.cloud().size() - cloud->size();
  watch.lap(report.seconds_index);
  measure_spacings(options, sampling);
  sampling.footprint = sampling.spacing;
  const Noise noise = options.paper ? Noise{} : measure_noise(sampling.grid, sampling.footprint);
  sampling.noise = noise.sigma;
  const bool noisy = noise.sigma > kNoisy * sampling.footprint;
  sampling.voxel = options.voxel.value_or(noisy ? kLeafSpacings * sampling.footprint : 0);
  watch.lap(report.seconds_spacing);
  if (sampling.voxel > 0) thin(noise, options, less, cloud, sampling, report);
  if (sampling.local.sigmas.empty()) {
    sampling.local.sigmas.assign(sampling.grid.size(), static_cast<float>(noise.sigma));
  }
  if (options.paper && !options.radius) sampling.spacing = mean_spacing(sampling.grid);
  take_columns(*cloud, options, sampling);
  report.spacing = sampling.spacing;
  report.noise = sampling.noise;
  report.voxel = sampling.voxel;
  return sampling;
}

}  // namespace palpate
