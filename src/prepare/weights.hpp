// The fifth step of prepare(): the weights of points on a surface that is sampled more or less
// densely.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/neighborhood_graph.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/geometry/cell_grid.hpp"
#include "palpate/prepare/prepare.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"

namespace palpate {

/// S_i and Sbar_i of docs/method.md 2.2, in sorted order; radii are the R_i, m:
///
///   S_i = sum_j w(|p_i - p_j| / R_j),  the point itself included
///   Sbar_i = sum_j w_ij S_j / sum_j w_ij
struct WeightSums {
  WeightSums() = default;  ///< of no point
  /// Sums over the neighbours in whose support a point is: the graph holds these radii.
  /// @throws Error when there are not as many radii as points, or one is not positive and finite.
  WeightSums(const detail::NeighborhoodGraph& graph, std::span<const float> radii,
             Kernel kernel = Kernel::wyvill);

  /// Sums as of these `radii`, where they were those of the radii `before`: looks again at what
  /// those that changed reach. The graph holds both.
  /// @throws Error as above.
  void update(const detail::NeighborhoodGraph& graph, std::span<const float> before,
              std::span<const float> radii, Kernel kernel = Kernel::wyvill);

  std::vector<float> own;     ///< S_i, at least 1
  std::vector<float> around;  ///< Sbar_i
};

/// What each point counts, so that a sampled surface weighs about 1 however dense its points are:
/// a_i = 1 / max(S_i, 0.8 Sbar_i). Positive and at most 1.
[[nodiscard]] std::vector<float> density_weights(const WeightSums& sums);

/// Lets points that stand for many weigh more than those that stand for few: multiplies each
/// density weight by the point's count over the mean count within its radius. Sums of weights stay
/// near 1, and means over points become means over what was measured, which halves their noise. All
/// in sorted order; radii in m, which the graph holds.
void weigh_by_counts(const detail::NeighborhoodGraph& graph, std::span<const std::uint32_t> counts,
                     std::span<const float> radii, std::vector<float>& weights);

/// 1 for each point, in sorted order, that noise has put where no surface is: fewer than three
/// others are within 2 R_i and 2 R_j of each other (docs/method.md 5.4). `own`: WeightSums' of the
/// same radii.
[[nodiscard]] std::vector<std::uint8_t> radius_outliers(const CellGrid& grid,
                                                        std::span<const float> radii,
                                                        std::span<const float> own);

struct Weights {
  std::vector<float> values;  ///< a_i in sorted order; 0: noise put the point there
  std::size_t outliers = 0;   ///< how many are 0
};

/// Density weights (docs/method.md 2.2) by the `sums` of the radii, by how many points each stands
/// for, and 0 for radius and isolated outliers, which stay in the index.
[[nodiscard]] Weights weigh(const detail::NeighborhoodGraph& graph, const Sampling& sampling,
                            const Radii& radii, const WeightSums& sums,
                            const PrepareOptions& options);

}  // namespace palpate
