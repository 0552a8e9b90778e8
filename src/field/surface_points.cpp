// Completes surface points.

#include "palpate/field/surface_points.hpp"

#include <algorithm>

#include "geometry/neighborhoods.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

// How far each point reaches from its start: R_i plus the distance to its end, m.
std::vector<float> reaches(const SurfacePoints& points) {
  std::vector<float> reach = points.radii;
  for (std::size_t i = 0; i < points.end_radii.size(); ++i) {
    reach[i] = std::max(reach[i], points.end_radii[i]);
  }
  for (std::size_t i = 0; i < points.end_positions.size(); ++i) {
    reach[i] += (points.end_positions[i] - points.grid.points()[i]).norm();
  }
  return reach;
}

}  // namespace

Box SurfacePoints::bounds() const {
  if (grid.cells().empty()) return {};
  const CellGrid::Cell& root = grid.cells().front();
  return {origin + root.lower.cast<double>(), origin + root.upper.cast<double>()};
}

void finish(SurfacePoints& points) {
  points.cell_reach = detail::largest_in_cells(points.grid, reaches(points));
  if (points.radii.empty()) return;
  points.radius = median(points.radii);
  points.smallest_radius = *std::min_element(points.radii.begin(), points.radii.end());
  for (const float radius : points.end_radii) {
    points.smallest_radius = std::min<double>(points.smallest_radius, radius);
  }
}

}  // namespace palpate
