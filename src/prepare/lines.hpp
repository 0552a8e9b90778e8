// Lines of points, and the gaps between them: slices of a volume, the lines of a scanner.
#pragma once

#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Do points lie on lines (slices of a volume, the lines of a scanner), whose own points are nearer
/// than those of the next line?
[[nodiscard]] bool lies_in_lines(const CellGrid& grid);

/// The spacings (m, in sorted order) of points on lines: those of the square grid with equally wide
/// holes, so that supports bridge the gaps between lines; 0 of points on none. Points without lines
/// on both sides take the spacing of the next line. Looks for lines up to 256 times as far apart as
/// points, and farther where noise hides how near these are.
[[nodiscard]] std::vector<float> spacings_of_lines(const CellGrid& grid);

/// Raises spacings (m) to those of lines.
void widen_to_lines(const std::vector<float>& of_lines, std::vector<float>& spacings);

}  // namespace palpate
