#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "prepare/own_sheets.hpp"

namespace palpate {

/// Raises the support radii (m) of points that hardly any other's support reaches, though others
/// lie on opposite sides of them, to 2.5 times the way to those, where one sheet goes on over the
/// gap; that sheet becomes the point's own, and the way its spacing. Beside far denser points (a
/// handful of near-duplicates is enough) spacings and limit_growth() make R too small, which tears
/// a hole. A stray point has all others on one side and keeps its radius; so does the corner of a
/// sheet. Returns how many were raised. Does not depend on the number of threads.
std::size_t close_gaps(const CellGrid& grid, std::span<const float> sums,
                       std::vector<float>& spacings, std::vector<float>& radii, OwnSheets& own);

}  // namespace palpate
