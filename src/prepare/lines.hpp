// Lines of points, and the gaps between them: slices of a volume, the lines of a scanner.
#pragma once

#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Do points lie on lines (slices of a volume, the lines of a scanner), whose own points are nearer
/// than those of the next line?
[[nodiscard]] bool lies_in_lines(const CellGrid& grid);

/// Raises the spacings (m) of points on lines to those of the square grid with equally wide holes,
/// so that supports bridge the gaps between lines. Points without lines on both sides take the
/// spacing of the next line. Looks for lines up to 30 times as far apart as points.
void widen_to_lines(const CellGrid& grid, std::vector<float>& spacings);

}  // namespace palpate
