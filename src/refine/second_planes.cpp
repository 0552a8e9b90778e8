// Doubles the points that lie on two segments.

#include "refine/second_planes.hpp"

#include <Eigen/Core>
#include <vector>

namespace palpate {

void add_second_planes(std::span<const SecondPlane> second_planes, SurfacePoints& points) {
  if (second_planes.empty()) return;
  SurfacePoints::Segments& segments = points.segments;
  for (const SecondPlane& second : second_planes) points.density_weights[second.point] *= 0.5f;
  std::vector<Eigen::Vector3f> positions(points.grid.points().begin(), points.grid.points().end());
  const auto append = [&](auto& column, std::uint32_t SecondPlane::*from) {
    if (column.empty()) return;
    for (const SecondPlane& second : second_planes) column.push_back(column[second.*from]);
  };
  append(positions, &SecondPlane::point);
  points.grid = CellGrid(positions);

  // A second plane has its point's columns; the normal and what concerns segments are its owner's.
  const auto add = [&](auto& column, std::uint32_t SecondPlane::*from) {
    append(column, from);
    if (!column.empty()) column = in_grid_order(points.grid, column);
  };
  add(points.density_weights, &SecondPlane::point);
  add(points.radii, &SecondPlane::point);
  add(points.confidences, &SecondPlane::point);
  add(points.materials, &SecondPlane::point);
  add(points.colors, &SecondPlane::point);
  add(points.normals, &SecondPlane::owner);
  add(segments.segment, &SecondPlane::owner);
  add(segments.residual, &SecondPlane::owner);
}

void refine_second_planes(Surfels& surfels) {
  add_second_planes(surfels.second_planes, surfels.prepared.points);
}

}  // namespace palpate
