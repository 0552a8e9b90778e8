#include "palpate/field/density.hpp"

#include <algorithm>

#include "geometry/weight_sums.hpp"

namespace palpate {

std::vector<float> density_weights(const CellGrid& grid, std::span<const float> radii,
                                   Kernel kernel) {
  constexpr float kShareOfAround = 0.8f;
  const simd::JoinFunctions& joins = simd::best_joins();
  const auto sums = detail::weight_sums(
      grid, radii, kernel == Kernel::wyvill ? joins.wyvill_sums : joins.wendland_sums);
  std::vector<float> weights(grid.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 1 / std::max(sums.own[i], kShareOfAround * sums.around[i]);
  }
  return weights;
}

}  // namespace palpate
