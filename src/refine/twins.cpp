// Doubles the points that lie on two sheets.

#include "refine/twins.hpp"

#include <Eigen/Core>
#include <vector>

namespace palpate {

void add_twins(std::span<const Twin> twins, SurfacePoints& points) {
  if (twins.empty()) return;
  SurfacePoints::Sheets& sheets = points.sheets;
  for (const Twin& twin : twins) points.density_weights[twin.point] *= 0.5f;
  std::vector<Eigen::Vector3f> positions(points.grid.points().begin(), points.grid.points().end());
  const auto append = [&](auto& column, std::uint32_t Twin::*from) {
    if (column.empty()) return;
    for (const Twin& twin : twins) column.push_back(column[twin.*from]);
  };
  append(positions, &Twin::point);
  points.grid = CellGrid(positions);

  // A twin copies its point's columns; the normal and what concerns sheets are its host's.
  const auto add = [&](auto& column, std::uint32_t Twin::*from) {
    append(column, from);
    if (!column.empty()) column = in_grid_order(points.grid, column);
  };
  add(points.density_weights, &Twin::point);
  add(points.radii, &Twin::point);
  add(points.confidences, &Twin::point);
  add(points.materials, &Twin::point);
  add(points.colors, &Twin::point);
  add(points.normals, &Twin::host);
  add(sheets.sheet, &Twin::host);
  add(sheets.residual, &Twin::host);
}

void refine_twins(Surfels& surfels) {
  add_twins(surfels.twins, surfels.prepared.points);
}

}  // namespace palpate
