#include "field/density.hpp"

#include <algorithm>

namespace palpate {

std::vector<float> density_weights(const CellGrid& grid, std::span<const float> radii,
                                   Kernel kernel) {
  return density_weights(weight_sums(grid, radii, kernel));
}

detail::WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii, Kernel kernel) {
  const simd::JoinFunctions& joins = simd::best_joins();
  return detail::weight_sums(grid, radii,
                             kernel == Kernel::wyvill ? joins.wyvill_sums : joins.wendland_sums);
}

std::vector<float> density_weights(const detail::WeightSums& sums) {
  constexpr float kShareOfAround = 0.8f;
  std::vector<float> weights(sums.own.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 1 / std::max(sums.own[i], kShareOfAround * sums.around[i]);
  }
  return weights;
}

}  // namespace palpate
