#pragma once

#include <vector>

#include "geometry/weight_sums.hpp"
#include "palpate/field/kernel.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Raises the support radii of points that hardly any other's support reaches, though others lie on
/// opposite sides of them, to 2.5 times the way to those: beside far denser points (a handful of
/// near-duplicates is enough) spacings and limit_growth() make them too small, which tears a hole.
/// A stray point has all others on one side and keeps its radius; so does the corner of a sheet.
/// `sums.own` follows; `sums.around` does not. All in sorted order, m. Returns how many were
/// raised. Does not depend on the number of threads.
std::size_t close_gaps(const CellGrid& grid, Kernel kernel, std::vector<float>& radii,
                       detail::WeightSums& sums);

}  // namespace palpate
