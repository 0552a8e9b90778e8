// Fits the plane of each point, and a quadric where that does not do.

#include "prepare/plane_fits.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "geometry/near_pairs.hpp"
#include "geometry/normals.hpp"
#include "prepare/given_normals.hpp"
#include "prepare/segment_fit.hpp"

namespace palpate {

void take_fit(const SegmentFit& fit, std::size_t i, PointFits& own) {
  own.normals[i] = fit.normal.cast<float>();
  own.confidences[i] = static_cast<float>(fit.planarity);
  own.residuals[i] = static_cast<float>(fit.residual);
  own.quadric_residuals[i] = static_cast<float>(fit.quadric_residual);
}

SegmentFit fit_of(const PointFits& own, std::size_t i) {
  SegmentFit fit;
  fit.normal = own.normals[i].cast<double>();
  fit.planarity = static_cast<double>(own.confidences[i]);
  fit.residual = static_cast<double>(own.residuals[i]);
  fit.quadric_residual = static_cast<double>(own.quadric_residuals[i]);
  return fit;
}

namespace {

std::vector<float> reaches_of(std::span<const float> radii) {
  std::vector<float> reaches(radii.begin(), radii.end());
  for (float& reach : reaches) reach *= kNeighborsReach;
  return reaches;
}

}  // namespace

detail::NeighborhoodGraph neighborhood_graph(const CellGrid& grid, std::span<const float> radii) {
  detail::NeighborhoodGraph graph(grid, reaches_of(radii), radii);
  graph.keep();
  return graph;
}

void widen(detail::NeighborhoodGraph& graph, std::span<const float> radii) {
  graph.widen(reaches_of(radii), radii);
}

PointFits fit_points(const detail::NeighborhoodGraph& graph, std::span<const float> spacings,
                     std::span<const float> radii, std::span<const float> noise) {
  const CellGrid& grid = graph.grid();
  Normals planes = estimate_normals(graph, radii, kNormalsReach);
  PointFits segments{std::move(planes.normals),
                     std::move(planes.confidences),
                     std::move(planes.residuals),
                     {},
                     std::vector<std::uint8_t>(grid.size()),
                     std::move(planes.asides)};
  segments.quadric_residuals = segments.residuals;
  std::vector<float> reaches(grid.size());  // of second fits, m; 0: the plane does
  const auto flat_at = [&](std::size_t i) {
    return flat_residual(static_cast<double>(radii[i]), static_cast<double>(noise[i]));
  };
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const auto residual = static_cast<double>(segments.residuals[i]);
    if (residual > flat_at(i)) reaches[i] = kNormalsReach * radii[i];
  }
  const auto refit = [&](SegmentFitter& fitter, std::uint32_t i,
                         std::span<const std::uint32_t> near, auto /*around*/) {
    const SegmentFit fit = fitter.fit(grid, grid.points()[i], near, static_cast<double>(reaches[i]),
                                      static_cast<double>(spacings[i]), flat_at(i));
    take_fit(fit, i, segments);
    segments.others[i] = fit.others ? 1 : 0;
  };
  detail::for_each_near(
      graph, reaches, [] { return SegmentFitter(); }, refit);
  return segments;
}

PointFits fit_planes(const detail::NeighborhoodGraph& graph, const Sampling& sampling,
                     const Radii& radii, const PrepareOptions& options) {
  if (!options.estimate_normals) return {};
  PointFits fits = fit_points(graph, sampling.spacings, radii.values, sampling.local.sigmas);
  if (!sampling.normals.empty()) {
    take_given_normals(sampling.grid, sampling.normals, fits.normals);
  }
  for (std::size_t i = 0; i < radii.outliers.size(); ++i) {
    if (radii.outliers[i] != 0) fits.confidences[i] = 0;
  }
  return fits;
}

}  // namespace palpate
