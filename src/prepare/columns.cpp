#include "prepare/columns.hpp"

#include <algorithm>

namespace palpate {

std::vector<float> materials_of(const CellGrid& grid, const std::vector<float>& intensities) {
  auto materials = in_grid_order(grid, intensities);
  const auto [low, high] = std::minmax_element(materials.begin(), materials.end());
  const float from = *low;
  const float range = *high - *low;
  for (float& m : materials) m = range > 0 ? (m - from) / range : 1.0f;
  return materials;
}

}  // namespace palpate
