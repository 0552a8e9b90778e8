#pragma once

#include <span>
#include <vector>

#include "geometry/weight_sums.hpp"
#include "palpate/field/field_options.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// What each point counts, so that a sampled surface weighs about 1 however dense its points are
/// (docs/method.md 2.2):
///
///   S_i = sum_j w(|p_i - p_j| / R_j),  the point itself included
///   Sbar_i = sum_j w_ij S_j / sum_j w_ij
///   a_i = 1 / max(S_i, 0.8 Sbar_i)
///
/// Sorted order; radii are the R_i, m. Positive and at most 1.
/// @throws Error when there are not as many radii as points, or one is not positive and finite.
[[nodiscard]] std::vector<float> density_weights(const CellGrid& grid, std::span<const float> radii,
                                                 Kernel kernel = Kernel::wyvill);

/// The sums that density_weights() is made of, for those who need them for more than that.
[[nodiscard]] detail::WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii,
                                             Kernel kernel);

[[nodiscard]] std::vector<float> density_weights(const detail::WeightSums& sums);

}  // namespace palpate
