// Looks at single points and at the positions nearest to them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The point itself and its nearest others, `count` in all, no two of them nearer to each other
/// than a fifth of the way to the farthest: points that were seen twice count once, and so does a
/// cluster far away. Fewer where most points around are of such a kind.
void nearest_places(const CellGrid& grid, std::uint32_t i, std::size_t count,
                    std::vector<CellGrid::Neighbor>& places);

/// Calls visit(i) for about a thousand points, spread over the cloud. Clouds of fewer than 100
/// points tell nothing: none.
template <class Visit>
void each_sample(const CellGrid& grid, const Visit& visit) {
  constexpr std::size_t kSamples = 1000;  // points, about; judgement
  constexpr std::size_t kFewest = 100;    // points of a cloud; judgement
  if (grid.size() < kFewest) return;
  const std::size_t step = std::max<std::size_t>(1, grid.size() / kSamples);
  for (std::size_t i = step / 2; i < grid.size(); i += step) visit(static_cast<std::uint32_t>(i));
}

}  // namespace palpate
