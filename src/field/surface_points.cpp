#include "palpate/field/surface_points.hpp"

#include <algorithm>

#include "geometry/neighborhoods.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

// R_i plus the way to go.
std::vector<float> reaches(const SurfacePoints& points) {
  std::vector<float> reach = points.radii;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    reach[i] += (points.end_positions[i] - points.grid.points()[i]).norm();
  }
  return reach;
}

}  // namespace

void finish(SurfacePoints& points) {
  points.cell_reach = points.end_positions.empty()
                          ? detail::largest_in_cells(points.grid, points.radii)
                          : detail::largest_in_cells(points.grid, reaches(points));
  if (points.radii.empty()) return;
  points.radius = median(points.radii);
  points.smallest_radius = *std::min_element(points.radii.begin(), points.radii.end());
}

}  // namespace palpate
