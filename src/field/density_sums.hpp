#pragma once

#include <span>
#include <vector>

#include "geometry/weight_sums.hpp"
#include "palpate/field/kernel.hpp"

namespace palpate {

/// The sums that density_weights() is made of, for those who need them for more than that.
[[nodiscard]] detail::WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii,
                                             Kernel kernel);

[[nodiscard]] std::vector<float> density_weights(const detail::WeightSums& sums);

}  // namespace palpate
