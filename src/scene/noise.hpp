#pragma once

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The noise of raw points: the median over a sample of them of the rms distance from a smooth
/// surface fitted to the neighbourhood, m. `spacing`: of the points, m.
[[nodiscard]] double plane_noise(const CellGrid& grid, double spacing);

}  // namespace palpate
