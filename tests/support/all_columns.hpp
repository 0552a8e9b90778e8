#pragma once

#include <cstddef>

#include "support/snapshots.hpp"

namespace palpate::test {

/// A sheet of 81 points that have every column.
inline SurfacePoints all_columns() {
  using Eigen::Vector3f;
  SurfacePoints p = make_points(plane(0, 4e-3, 4));
  const std::size_t n = p.size();
  p.segments.segment.assign(n, 0);
  p.segments.segment.back() = SurfacePoints::Segments::kNone;
  p.segments.component = {0};
  p.segments.known = {1};
  p.segments.residual.assign(n, 1e-4f);
  p.materials.assign(n, 0.5f);
  p.presences.assign(n, 1);
  p.colors.assign(n, {1, 2, 3});
  p.end_positions.assign(p.grid.points().begin(), p.grid.points().end());
  for (Vector3f& end : p.end_positions) end.z() += 1e-3f;
  p.end_normals = p.normals;
  p.end_density_weights = p.density_weights;
  p.end_radii = p.radii;
  p.end_confidences = p.confidences;
  p.end_presences = p.presences;
  p.edges.of_point.assign(n, SurfacePoints::Edges::kNone);
  p.edges.of_point[2] = 0;
  p.edges.start = {{Vector3f::UnitX(), 1e-3f, 0.5f}};
  p.edges.end = p.edges.start;
  p.eye.emplace(SurfaceEye{{0, 0, 0.7}, {Vector3f::UnitZ(), Vector3f::UnitZ()}});
  finish(p);
  return p;
}

}  // namespace palpate::test
