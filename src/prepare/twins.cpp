#include "prepare/twins.hpp"

#include <limits>
#include <utility>
#include <vector>

#include "prepare/columns.hpp"

namespace palpate {

void add_twins(std::span<const Twin> twins, SurfacePoints& points) {
  if (twins.empty()) return;
  PointSheets& sheets = points.sheets;
  for (const Twin& twin : twins) points.density_weights[twin.point] *= 0.5f;
  std::vector<Eigen::Vector3f> positions(points.grid.points().begin(), points.grid.points().end());
  const auto append = [&](auto& column, std::uint32_t Twin::*from) {
    if (column.empty()) return;
    for (const Twin& twin : twins) column.push_back(column[twin.*from]);
  };
  append(positions, &Twin::point);
  points.grid = CellGrid(positions);

  // All of a twin is the point's but what its host knows of the sheet.
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
  add(sheets.above, &Twin::host);
  add(sheets.below, &Twin::host);
}

}  // namespace palpate
