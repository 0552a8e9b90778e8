// Looks at single points and what lies nearest to them.

#include "prepare/places.hpp"

namespace palpate {

namespace {

/// Leaves the places of at most `count` of the points that were found, nearest first.
void keep_places(const CellGrid& grid, std::size_t count, std::vector<CellGrid::Neighbor>& found) {
  constexpr float kOnePlace = 0.2f;  // of the way to the farthest: 0.7 and more on a grid
  const float apart = kOnePlace * kOnePlace * found[count - 1].squared_distance;
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

void nearest_places(const CellGrid& grid, std::uint32_t i, std::size_t count,
                    std::vector<CellGrid::Neighbor>& places) {
  constexpr std::size_t kCopies = 4;  // of each place, on the average; judgement
  // The first `count` are most often places of their own: then farther ones change nothing.
  for (std::size_t asked = count; asked <= kCopies * count; asked *= 2) {
    grid.nearest(grid.points()[i], asked, places);
    if (places.size() < count) return;
    keep_places(grid, count, places);
    if (places.size() == count) return;
  }
}

}  // namespace palpate
