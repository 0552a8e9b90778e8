// Lines of points, and the gaps between them: slices of a volume, the lines of a scanner.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The line that a point and its nearest places are on.
struct Line {
  Eigen::Vector3f along = Eigen::Vector3f::UnitX();
  float spacing = 0;  ///< m, to the farthest of the nearest
  float step = 0;     ///< m, from one of them to the next
  float off = 1;      ///< deviation across the line, against that along it
};

/// The line of the point and the four places nearest to it. `nearest`: memory.
[[nodiscard]] Line line_at(const CellGrid& grid, std::uint32_t i,
                           std::vector<CellGrid::Neighbor>& nearest);

/// The gap that a point lies in, m: the further of the nearest two beside its line, on opposite
/// sides of it. Looks within `reach` (m), and within twice as much each time that it finds none,
/// `times` in all; 0: there is none. `near`: memory.
[[nodiscard]] float gap_across(const CellGrid& grid, std::uint32_t i, const Line& line, float reach,
                               int times, std::vector<std::uint32_t>& near);

/// Do points lie on lines (slices of a volume, the lines of a scanner), whose own points are nearer
/// than those of the next line?
[[nodiscard]] bool lies_in_lines(const CellGrid& grid);

/// Raises the spacings (m) of points on lines to those of the square grid with equally wide holes,
/// so that supports bridge the gaps between lines. Points without lines on both sides take the
/// spacing of the next line. Looks for lines up to 30 times as far apart as points.
void widen_to_lines(const CellGrid& grid, std::vector<float>& spacings);

}  // namespace palpate
