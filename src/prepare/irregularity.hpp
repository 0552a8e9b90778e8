#pragma once

#include <span>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// How far a point's nearest other is, in spacings: the median over a sample of the points. 1 on a
/// square grid, 0.9 where each is off its place by up to a tenth of the spacing, 0.5 where points
/// lie anywhere (Clark and Evans 1954). 1 where there are too few points to tell. `spacings`: those
/// of the points, in sorted order, m.
[[nodiscard]] double nearest_share(const CellGrid& grid, std::span<const float> spacings);

/// Do the points lie so irregularly that the gaps between them need a larger support?
[[nodiscard]] bool is_irregular(const CellGrid& grid, std::span<const float> spacings);

}  // namespace palpate
