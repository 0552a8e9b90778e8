#include "palpate/field/surface_points.hpp"

#include <algorithm>

#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

float reach(const SurfacePoints& points, std::uint32_t i) {
  const float way = points.end_positions.empty()
                        ? 0.0f
                        : (points.end_positions[i] - points.grid.points()[i]).norm();
  return points.radii[i] + way;
}

}  // namespace

void finish(SurfacePoints& points) {
  const auto cells = points.grid.cells();
  points.cell_reach.assign(cells.size(), 0.0f);
  for (std::size_t c = cells.size(); c-- > 0;) {  // children stand behind their parents
    float& largest = points.cell_reach[c];
    for (std::uint32_t k = 0; k < cells[c].children; ++k) {
      largest = std::max(largest, points.cell_reach[cells[c].first_child + k]);
    }
    if (cells[c].children > 0) continue;
    for (std::uint32_t i = cells[c].begin; i < cells[c].end; ++i) {
      largest = std::max(largest, reach(points, i));
    }
  }
  if (points.radii.empty()) return;
  points.radius = median(points.radii);
  points.smallest_radius = *std::min_element(points.radii.begin(), points.radii.end());
}

}  // namespace palpate
