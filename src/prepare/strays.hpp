// Points that are evidence of no surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// 1 for each point that is farther from others than most, has none within `typical`, and whose
/// nearest places lie neither in a sheet nor along a line, nor around it in several sheets.
/// `spacings`: of the points, `typical`: their median, m. In sorted order.
[[nodiscard]] std::vector<std::uint8_t> find_strays(const CellGrid& grid,
                                                    std::span<const float> spacings,
                                                    double typical);

}  // namespace palpate
