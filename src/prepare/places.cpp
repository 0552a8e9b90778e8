// Looks at single points and what lies nearest to them.

#include "prepare/places.hpp"

namespace palpate {

void nearest_places(const CellGrid& grid, std::uint32_t i, std::size_t count,
                    std::vector<CellGrid::Neighbor>& places) {
  constexpr std::size_t kCopies = 4;  // of each place, on the average; judgement
  constexpr float kOnePlace = 0.2f;   // of the way to the farthest: 0.7 and more on a grid
  grid.nearest(grid.points()[i], kCopies * count, places);
  if (places.size() < count) return;
  const float apart = kOnePlace * kOnePlace * places[count - 1].squared_distance;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < places.size() && kept < count; ++k) {
    const Eigen::Vector3f& here = grid.points()[places[k].index];
    const auto is_near = [&](const CellGrid::Neighbor& other) {
      return (grid.points()[other.index] - here).squaredNorm() < apart;
    };
    const auto end = places.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::none_of(places.begin(), end, is_near)) places[kept++] = places[k];
  }
  places.resize(kept);
}

}  // namespace palpate
