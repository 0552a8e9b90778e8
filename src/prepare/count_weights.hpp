#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Lets points that stand for many weigh more than those that stand for few: multiplies each
/// density weight by the point's count over the mean count within its radius. Sums of weights stay
/// near 1, and means over points become means over what was measured, which halves their noise. All
/// in sorted order; radii in m.
void weigh_by_counts(const CellGrid& grid, std::span<const std::uint32_t> counts,
                     std::span<const float> radii, std::vector<float>& weights);

}  // namespace palpate
