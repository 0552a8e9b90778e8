// Looks at single points and at the positions nearest to them.

#include "prepare/places.hpp"

namespace palpate {

namespace {

/// Leaves at most `count` of the points that were found, at distinct positions, nearest first.
void keep_distinct(const CellGrid& grid, std::size_t count,
                   std::vector<CellGrid::Neighbor>& found) {
  constexpr float kSamePosition = 0.2f;  // of the distance to the farthest: 0.7 and more on a grid
  const float apart = kSamePosition * kSamePosition * found[count - 1].squared_distance;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < found.size() && kept < count; ++k) {
    const Eigen::Vector3f& here = grid.points()[found[k].index];
    const auto is_near = [&](const CellGrid::Neighbor& other) {
      return (grid.points()[other.index] - here).squaredNorm() < apart;
    };
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::none_of(found.begin(), end, is_near)) found[kept++] = found[k];
  }
  found.resize(kept);
}

}  // namespace

void nearest_distinct(const CellGrid& grid, std::uint32_t i, std::size_t count,
                      std::vector<CellGrid::Neighbor>& nearest) {
  constexpr std::size_t kCopies = 4;  // of each position, on the average; judgement
  // The first `count` are most often distinct: then farther ones change nothing.
  for (std::size_t tried = count; tried <= kCopies * count; tried *= 2) {
    grid.nearest(grid.points()[i], tried, nearest);
    if (nearest.size() < count) return;
    keep_distinct(grid, count, nearest);
    if (nearest.size() == count) return;
  }
}

}  // namespace palpate
