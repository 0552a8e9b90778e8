#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/simd/joins.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// S_i and Sbar_i of docs/method.md 2.2, in sorted order.
struct WeightSums {
  std::vector<float> own;     ///< S_i = sum_j w_ij, at least 1
  std::vector<float> around;  ///< Sbar_i = sum_j w_ij S_j / S_i
};

/// One of simd::JoinFunctions' sums: says which kernel w is.
using WeightSum = decltype(simd::JoinFunctions::wyvill_sums);

/// w_ij = w(|p_i - p_j| / R_j), radii: the R_j, m.
/// @throws Error when there are not as many radii as points, or one is not positive and finite.
[[nodiscard]] WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii,
                                     WeightSum sum);

/// speckle_mask() for those who have the weight sums of the same radii already.
[[nodiscard]] std::vector<std::uint8_t> speckle_mask(const CellGrid& grid,
                                                     std::span<const float> radii,
                                                     const WeightSums& sums);

}  // namespace palpate::detail
