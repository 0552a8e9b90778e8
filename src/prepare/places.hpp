// Looks at single points and at the positions nearest to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The point itself and its nearest others, `count` in all, no two of them nearer to each other
/// than a fifth of the distance to the farthest: points that were seen twice count once, and so
/// does a cluster far away. Fewer where most points around are of such a kind.
void nearest_distinct(const CellGrid& grid, std::uint32_t i, std::size_t count,
                      std::vector<CellGrid::Neighbor>& nearest);

}  // namespace palpate
