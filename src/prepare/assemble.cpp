// Puts the columns of all steps together and counts what came of them.

#include "prepare/assemble.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate {
namespace {

constexpr float kTrusted = 0.5f;  // confidence; judgement

/// 0 at the lowest, 1 at the highest intensity.
std::vector<float> materials_of(std::vector<float> materials) {
  const auto [low, high] = std::minmax_element(materials.begin(), materials.end());
  const float from = *low;
  const float range = *high - *low;
  for (float& m : materials) m = range > 0 ? (m - from) / range : 1.0f;
  return materials;
}

/// How far the normals of what is felt are trusted.
void tell_trust(const SurfacePoints& points, Prepared::Report& report) {
  std::vector<float> felt;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.density_weights[i] > 0) felt.push_back(points.confidences[i]);
  }
  if (felt.empty()) return;
  const auto tenth = felt.begin() + static_cast<std::ptrdiff_t>(felt.size() / 10);
  std::nth_element(felt.begin(), tenth, felt.end());
  report.trust_low = *tenth;
  const auto doubted = std::ranges::count_if(felt, [](float c) { return c < kTrusted; });
  report.untrusted = static_cast<double>(doubted) / static_cast<double>(felt.size());
}

}  // namespace

void add_twins(std::span<const Twin> twins, SurfacePoints& points) {
  if (twins.empty()) return;
  SurfacePoints::Sheets& sheets = points.sheets;
  for (const Twin& twin : twins) points.density_weights[twin.point] *= 0.5f;
  std::vector<Eigen::Vector3f> positions(points.grid.points().begin(), points.grid.points().end());
  const auto append = [&](auto& column, std::uint32_t Twin::*from) {
    if (column.empty()) return;
    for (const Twin& twin : twins) column.push_back(column[twin.*from]);
  };
  append(positions, &Twin::point);
  points.grid = CellGrid(positions);

  // A twin copies its point's columns; the normal and what concerns sheets are its host's.
  const auto add = [&](auto& column, std::uint32_t Twin::*from) {
    append(column, from);
    if (!column.empty()) column = in_grid_order(points.grid, column);
  };
  add(points.density_weights, &Twin::point);
  add(points.radii, &Twin::point);
  add(points.confidences, &Twin::point);
  add(points.materials, &Twin::point);
  add(points.colors, &Twin::point);
  add(points.normals, &Twin::host);
  add(sheets.sheet, &Twin::host);
  add(sheets.residual, &Twin::host);
}

void complete(Prepared& prepared) {
  auto& [points, report] = prepared;
  finish(points);
  tell_trust(points, report);
  report.radius = points.radius;
  report.radius_smallest = points.smallest_radius;
  report.radius_largest = 0;
  for (const float radius : points.radii) {
    report.radius_largest = std::max(report.radius_largest, static_cast<double>(radius));
  }
}

Prepared assemble(Sampling sampling, Radii radii, PointFits fits, Weights weights,
                  JoinedSheets joined, const PrepareOptions& options, Prepared::Report report) {
  SurfacePoints points;
  points.origin = sampling.origin;
  points.grid = std::move(sampling.grid);
  points.radii = std::move(radii.values);
  points.density_weights = std::move(weights.values);
  points.kernel = options.kernel;
  points.colors = std::move(sampling.colors);
  if (options.material_from_intensity) {
    points.materials = materials_of(std::move(sampling.intensities));
  }
  points.normals = std::move(fits.normals);
  points.confidences = std::move(fits.confidences);
  points.confidences.resize(points.size(), 0.0f);
  points.sheets = std::move(joined.sheets);
  add_twins(joined.twins, points);
  report.speckle = weights.speckle;
  report.points_out = points.size() - weights.speckle - joined.twins.size();
  Prepared prepared{std::move(points), report};
  complete(prepared);
  return prepared;
}

}  // namespace palpate
