// Part of the third step of prepare(), and of what follows the fourth: how fast R may vary.
#pragma once

#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

struct PointFits;

/// Lets support radii vary slowly over the surface, as the paper's section III-D assumes: each
/// becomes min_j (R_j + slope |p_i - p_j|). Then a sparse point's support ends before it reaches
/// what is sampled finely. In sorted order, m.
/// `own`: points on the plane of a point do not limit it, since it shows nothing else of them;
/// nullptr: all do.
void limit_radii(const CellGrid& grid, float slope, std::vector<float>& radii,
                 const PointFits* own = nullptr);

}  // namespace palpate
