// Holds a cloud during prepare(), and where refinements come in.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "geometry/neighborhood_graph.hpp"
#include "palpate/field/surface_points.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"
#include "prepare/point_fits.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/weights.hpp"

namespace palpate {

/// The second plane of a point where two segments meet in a crease or at an edge.
struct SecondPlane {
  std::uint32_t point = 0;
  std::uint32_t owner = 0;  ///< a point that is confident of that plane
};

/// What the steps of prepare() have made of a cloud so far. Columns are in sorted order.
struct Surfels {
  const Placed& placed;
  const PrepareOptions& options;
  Sampling sampling = {};
  Radii radii = {};
  detail::NeighborhoodGraph graph = {};  ///< of the sampling's points, until they are assembled
  PointFits fits = {};
  WeightSums sums = {};
  Weights weights = {};
  SurfacePoints::Segments segments = {};  ///< empty: all points are one, and their signs agree
  std::vector<SecondPlane> second_planes = {};  ///< in rising order
  Prepared prepared = {};  ///< the report from the start, the points at the end
};

/// The step of prepare() after which a refinement runs.
enum class Stage {
  radii,    ///< support radii are chosen
  fits,     ///< planes are fitted, and sums of weights are computed
  weights,  ///< points are weighed
  points,   ///< columns have become surface points
};

/// One thing that makes points better than the core does: floor `refine` lists all of them.
struct Refinement {
  std::string_view name;  ///< as PrepareOptions::without has it
  Stage stage;
  void (*refine)(Surfels& surfels);
};

/// Takes all steps of prepare() but place(), with these refinements in their order. `report`: what
/// has been measured so far.
/// @throws Error as prepare() does. The options' progress is called between two steps.
[[nodiscard]] Prepared prepare_at_once(const Placed& placed, const PrepareOptions& options,
                                       std::span<const Refinement> refinements,
                                       Prepared::Report report);

}  // namespace palpate
