// Finds where half of the light that falls on splats is gone.
#pragma once

#include <span>

#include "extras/splats/splat_cells.hpp"

namespace palpate::detail {

/// Sets the height of each point: where, along its normal, half of the light is gone that falls in
/// against the normal, or from behind; the mean of both by how much comes from either side. Splats
/// are taken where the ray through the point meets their strongest point, as renderers take them.
/// Looks `reach` cells to both sides. The height is 0 where more than half gets through, and for
/// points without a normal.
void find_half_light(std::span<SplatCell> points, std::span<const SplatShare> shares,
                     std::span<const Splat> splats, const SplatGrid& grid, float reach);

}  // namespace palpate::detail
