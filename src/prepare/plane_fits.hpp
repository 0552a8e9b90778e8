// The fourth step of prepare(): the plane of each point.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/neighborhood_graph.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/point_fits.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"

namespace palpate {

struct SegmentFit;

/// Makes a fit that of point i; `others` and `asides` stay as they are.
void take_fit(const SegmentFit& fit, std::size_t i, PointFits& own);
/// Returns what is kept of the fit of point i: its normal, planarity and residuals alone.
[[nodiscard]] SegmentFit fit_of(const PointFits& own, std::size_t i);

// R: normals are fitted a little wider than the surface is, as the balanced field adds their noise;
// judgement (docs/method.md 5.5).
inline constexpr float kNormalsReach = 1.15f;

// R: a point's neighbours are within this; derived: no step looks farther without a viewpoint
// (docs/preparation.md, Neighbours).
inline constexpr float kNeighborsReach = 1.3f;

/// Each point's neighbours within kNeighborsReach of its R, and those in whose support it is;
/// `radii`: R, m.
[[nodiscard]] detail::NeighborhoodGraph neighborhood_graph(const CellGrid& grid,
                                                           std::span<const float> radii);
/// Lets the graph hold those of these radii, too.
void widen(detail::NeighborhoodGraph& graph, std::span<const float> radii);

/// Fitted within kNormalsReach of each point's `radii`, which the graph holds; `noise`: sigma at
/// each, m. On every core.
[[nodiscard]] PointFits fit_points(const detail::NeighborhoodGraph& graph,
                                   std::span<const float> spacings, std::span<const float> radii,
                                   std::span<const float> noise);

/// Fits the points' planes and lets given normals take part; outliers get no confidence. Empty
/// where no normals are requested.
[[nodiscard]] PointFits fit_planes(const detail::NeighborhoodGraph& graph, const Sampling& sampling,
                                   const Radii& radii, const PrepareOptions& options);

}  // namespace palpate
