#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/weight_sums.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// speckle_mask() for those who have the weight sums of the same radii already.
[[nodiscard]] std::vector<std::uint8_t> speckle_mask(const CellGrid& grid,
                                                     std::span<const float> radii,
                                                     const WeightSums& sums);

}  // namespace palpate::detail
