#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "prepare/sheets.hpp"

namespace palpate {

/// How far a point's nearest other is, in spacings: the median over a sample of the points. 1 on a
/// square grid, 0.9 where each is off its place by up to a tenth of the spacing, 0.5 where points
/// lie anywhere (Clark and Evans 1954). 1 where there are too few points to tell. `spacings`: those
/// of the points, in sorted order, m.
[[nodiscard]] double nearest_share(const CellGrid& grid, std::span<const float> spacings);

/// Do the points lie so irregularly that the gaps between them need a larger support?
[[nodiscard]] bool is_irregular(const CellGrid& grid, std::span<const float> spacings);

/// Raises the support radii (m) of points that hardly any other's support reaches, though others
/// lie on opposite sides of them, to 2.5 times the way to those, where one sheet goes on over the
/// gap; that sheet becomes the point's own, and the way its spacing. Beside far denser points (a
/// handful of near-duplicates is enough) spacings and limit_growth() make R too small, which tears
/// a hole. A stray point has all others on one side and keeps its radius; so does the corner of a
/// sheet. Returns how many were raised. Does not depend on the number of threads.
std::size_t close_gaps(const CellGrid& grid, std::span<const float> sums,
                       std::vector<float>& spacings, std::vector<float>& radii, OwnSheets& own);

/// Lets support radii vary slowly from place to place, as the paper's section III-D assumes: each
/// becomes min_j (R_j + slope |p_i - p_j|). Then a sparse point's support ends before it reaches
/// what is sampled finely. In sorted order, m.
/// `own`: points on the plane of a point do not limit it, since it tells nothing else of them;
/// nullptr: all do.
void limit_growth(const CellGrid& grid, float slope, std::vector<float>& radii,
                  const OwnSheets* own = nullptr);

}  // namespace palpate
