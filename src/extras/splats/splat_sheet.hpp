// Draws the lit cells of splats together to a sheet.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "extras/splats/splat_cells.hpp"

namespace palpate::detail {

/// Points on a sheet along the cells, one a cell at most, where half of the light is gone.
/// `shares` are the cells' own.
[[nodiscard]] std::vector<SplatCell> drawn_together(std::vector<SplatCell> cells,
                                                    std::span<const SplatShare> shares,
                                                    std::span<const Splat> splats,
                                                    const SplatGrid& grid,
                                                    const std::function<void(double)>& progress);

}  // namespace palpate::detail
