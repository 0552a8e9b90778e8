// The refinement that puts points on smooth segments, and these into oriented components.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/neighborhood_graph.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "prepare/orientation.hpp"
#include "prepare/point_fits.hpp"
#include "prepare/surfels.hpp"
#include "refine/signed_graph.hpp"

namespace palpate {

/// Sorted points and what is measured of them before segments. The graph holds what
/// segment_reaches() says.
struct SegmentInput {
  const detail::NeighborhoodGraph& graph;
  std::span<const float> spacings;  // m
  std::span<const float> radii;     // m
  std::span<const float> noise;     // sigma at each point, m

  [[nodiscard]] const CellGrid& grid() const { return graph.grid(); }
};

/// How far from each point segments are looked for, m. `seen`: is there a viewpoint?
[[nodiscard]] std::vector<float> segment_reaches(std::span<const float> spacings,
                                                 std::span<const float> radii, bool seen);

/// Puts each point on a segment: confident points that continue each other's planes make one; an
/// uncertain point joins the segment whose plane it lies on and takes over its fit. Those that lie
/// on none are fitted to each other; without a plane they have no confidence left. Turns
/// `own.normals` so that they agree within a component, outward without other evidence.
///
/// Segments that lie side by side are one component where nearby pairs of their points agree on
/// what is outside: n_p, mirrored by the plane halfway between p and q, looks like n_q, as if an
/// arc joined the two. `second_planes`: gets those of points that lie on two segments, in rising
/// order.
[[nodiscard]] SurfacePoints::Segments make_segments(const SegmentInput& input,
                                                    const PriorSigns& prior, PointFits& own,
                                                    std::vector<SecondPlane>& second_planes);

/// Which segment each point lies on.
struct GrownSegments {
  SurfacePoints::Segments segments;        ///< every segment is a component of its own
  std::vector<std::uint8_t> confident;     ///< 1: by its own fit; 0: by another's, or none
  std::vector<SecondPlane> second_planes;  ///< in rising order
  std::vector<std::uint8_t>
      hidden;  ///< by look_around(), 1: another segment is near on the eye's side
};

/// The first half of make_segments(). Normals of one segment agree afterwards.
[[nodiscard]] GrownSegments grow_segments(const SegmentInput& input, PointFits& own);

/// How far the points i and j may be off each other's plane when they lie on one segment, m.
[[nodiscard]] float segment_tolerance(const SegmentInput& input, std::uint32_t i, std::uint32_t j);

/// How far look_around() looks, in R. `seen`: is there a viewpoint?
[[nodiscard]] float look_reach(bool seen);

/// Returns edges between segments by what pairs of their points say, a |a| of how far they agree
/// (-1 ... 1). Where there is an eye, notes which points another segment hides from it.
[[nodiscard]] std::vector<SignedEdge> look_around(const SegmentInput& input, const PointFits& own,
                                                  const std::optional<Eigen::Vector3f>& eye,
                                                  GrownSegments& grown);

inline constexpr std::uint32_t kUnassigned = ~std::uint32_t{0};  ///< no point: above every index

/// The planes that points lie on, in sorted order.
struct Snapped {
  std::vector<std::uint8_t> confident;  ///< 1: its own fit is a segment's; 0: another's, or none
  std::vector<std::uint32_t>
      assigned;  ///< the confident point whose plane each has, or kUnassigned
  std::vector<SecondPlane> second_planes;  ///< those that lie on a second plane
};

/// A point is confident of its plane where its own fit is smooth: the local quadric leaves a
/// residual below 0.03 R. At edges and creases, where it is not, a point takes over the fit of the
/// confident one on whose plane it lies. Points that lie on none are fitted to each other. One
/// without a plane has no confidence left, unless hardly any point around it is confident.
[[nodiscard]] Snapped snap_to_planes(const SegmentInput& input, PointFits& own);

/// The curvature of a confident point's fit, 1/m: a sphere's cap of radius a and curvature k is off
/// its plane by k a^2 / sqrt(48) RMS.
[[nodiscard]] float fitted_curvature(const SegmentInput& input, const PointFits& own,
                                     std::uint32_t i);

// Least height over the distance to the side of what lies over a point rather than beside it.
inline constexpr float kGapSlope = 0.5f;  // judgement

// How far normals may turn where both fits are curved, over what their arc turns.
inline constexpr float kTurnMargin = 1.5f;  // judgement
// How far a point may be off the other's plane, over distance times turn (rad): an arc has half.
inline constexpr float kChord = 0.6f;  // half and a margin; judgement

/// make_segments() of the points that weigh something. None where there are no fits.
void refine_segments(Surfels& surfels);

}  // namespace palpate
