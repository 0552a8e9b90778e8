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

void assemble(Surfels& surfels) {
  SurfacePoints& points = surfels.prepared.points;
  Sampling& sampling = surfels.sampling;
  points.origin = sampling.origin;
  points.grid = std::move(sampling.grid);
  points.radii = std::move(surfels.radii.values);
  points.density_weights = std::move(surfels.weights.values);
  points.kernel = surfels.options.kernel;
  points.colors = std::move(sampling.colors);
  if (surfels.options.material_from_intensity) {
    points.materials = materials_of(std::move(sampling.intensities));
  }
  points.normals = std::move(surfels.fits.normals);
  points.confidences = std::move(surfels.fits.confidences);
  points.confidences.resize(points.size(), 0.0f);
  points.segments = std::move(surfels.segments);
  Prepared::Report& report = surfels.prepared.report;
  report.speckle = surfels.weights.outliers;
  report.points_out = points.size() - report.speckle;
}

}  // namespace palpate
