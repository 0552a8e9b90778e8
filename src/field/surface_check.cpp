// Checks surface points that others made: every column's length, range and indices.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/neighborhoods.hpp"
#include "palpate/base/error.hpp"
#include "palpate/field/surface_points.hpp"

namespace palpate {
namespace {

using Numbers = std::vector<float>;
using Directions = std::vector<Eigen::Vector3f>;
using Indices = std::vector<std::uint32_t>;
using EdgePlanes = std::vector<SurfacePoints::EdgePlane>;

constexpr float kLarge = std::numeric_limits<float>::max();  // m or no unit: any finite value
constexpr float kSmall = std::numeric_limits<float>::min();  // m: any value above 0
// What a square of a unit direction's length may lack, far above what single precision rounds away
// (derived), far below what a force shows.
constexpr float kUnitError = 1e-3f;
// Share of a reach that rounding may take away: some units in the last place (derived).
constexpr float kReachError = 1e-5f;

void require_length(const char* column, std::size_t length, std::size_t expected) {
  if (length == expected) return;
  throw Error(
      fmt::format("surface points: {} has {} entries instead of {}; fill it, then call finish()",
                  column, length, expected));
}

/// Columns that may be empty are as long as `n` otherwise.
std::size_t or_empty(const auto& column, std::size_t n) {
  return column.empty() ? 0 : n;
}

void require_range(const char* column, const Numbers& values, float low, float high) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= low && values[i] <= high) continue;
    throw Error(fmt::format("surface points: {}[{}] is {}; it must lie between {} and {}", column,
                            i, values[i], low, high));
  }
}

void require_finite(const char* column, std::span<const Eigen::Vector3f> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].allFinite()) continue;
    throw Error(fmt::format("surface points: {}[{}] is not finite", column, i));
  }
}

/// `or_zero`: 0 stands for no direction.
void require_unit(const char* column, const Directions& values, bool or_zero) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float squared = values[i].squaredNorm();
    if (std::abs(squared - 1) <= kUnitError || (or_zero && values[i].isZero(0))) continue;
    throw Error(fmt::format("surface points: {}[{}] has the length {}; make it a unit vector{}",
                            column, i, std::sqrt(squared), or_zero ? " or 0" : ""));
  }
}

/// `none`: what stands for no index.
void require_below(const char* column, const Indices& values, std::size_t count,
                   const std::uint32_t* none = nullptr) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < count || (none && values[i] == *none)) continue;
    throw Error(fmt::format("surface points: {}[{}] is {}, but there are only {} of these", column,
                            i, values[i], count));
  }
}

void check_numbers(const SurfacePoints& points) {
  const std::size_t n = points.size();
  const auto check = [](const char* column, const Numbers& values, std::size_t expected, float low,
                        float high) {
    require_length(column, values.size(), expected);
    require_range(column, values, low, high);
  };
  const auto check_if_any = [&](const char* column, const Numbers& values, float low, float high) {
    check(column, values, or_empty(values, n), low, high);
  };
  check("radii", points.radii, n, kSmall, kLarge);
  check("density_weights", points.density_weights, n, 0, kLarge);
  check("confidences", points.confidences, n, 0, 1);
  check_if_any("materials", points.materials, 0, 1);
  check_if_any("presences", points.presences, 0, 1);
  check_if_any("end_radii", points.end_radii, kSmall, kLarge);
  check_if_any("end_density_weights", points.end_density_weights, 0, kLarge);
  check_if_any("end_confidences", points.end_confidences, 0, 1);
  check_if_any("end_presences", points.end_presences, 0, 1);
}

void check_vectors(const SurfacePoints& points) {
  const std::size_t n = points.size();
  if (!points.origin.allFinite()) throw Error("surface points: the origin is not finite");
  require_finite("grid", points.grid.points());
  require_length("normals", points.normals.size(), or_empty(points.normals, n));
  require_unit("normals", points.normals, true);
  require_length("end_normals", points.end_normals.size(), or_empty(points.end_normals, n));
  require_unit("end_normals", points.end_normals, true);
  require_length("end_positions", points.end_positions.size(), or_empty(points.end_positions, n));
  require_finite("end_positions", points.end_positions);
  require_length("colors", points.colors.size(), or_empty(points.colors, n));
}

void require_edges(const char* column, const EdgePlanes& edges) {
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const SurfacePoints::EdgePlane& edge = edges[k];
    const bool short_enough = edge.normal.squaredNorm() <= 1 + kUnitError;
    if (short_enough && std::isfinite(edge.height) && std::abs(edge.share) <= 1) continue;
    throw Error(
        fmt::format("surface points: {}[{}] has a height of {}, a share of {} and a normal of "
                    "length {}; the first must be finite, the others within 1",
                    column, k, edge.height, edge.share, edge.normal.norm()));
  }
}

void check_edges(const SurfacePoints::Edges& edges, std::size_t n) {
  require_length("edges.of_point", edges.of_point.size(), or_empty(edges.of_point, n));
  require_length("edges.end", edges.end.size(), or_empty(edges.end, edges.start.size()));
  require_below("edges.of_point", edges.of_point, edges.start.size(), &SurfacePoints::Edges::kNone);
  require_edges("edges.start", edges.start);
  require_edges("edges.end", edges.end);
}

void check_segments(const SurfacePoints::Segments& segments, std::size_t n) {
  const std::size_t expected = segments.empty() ? 0 : n;
  require_length("segments.segment", segments.segment.size(), expected);
  require_length("segments.residual", segments.residual.size(), expected);
  if (segments.empty()) {
    require_length("segments.component", segments.component.size(), 0);
    require_length("segments.known", segments.known.size(), 0);
  }
  require_below("segments.segment", segments.segment, segments.component.size(),
                &SurfacePoints::Segments::kNone);
  require_below("segments.component", segments.component, segments.known.size());
  require_range("segments.residual", segments.residual, 0, kLarge);
}

void check_eye(const SurfaceEye& eye, std::size_t n) {
  if (!eye.position.allFinite()) throw Error("surface points: the eye's position is not finite");
  if (eye.remembered.size() > n) {
    throw Error(fmt::format("surface points: the eye remembers {} points, but there are only {}",
                            eye.remembered.size(), n));
  }
  require_unit("eye.remembered", eye.remembered, false);
}

/// How far each point reaches out of its leaf's box: R_i, and how far its end is from there, m.
Numbers reaches_out(const SurfacePoints& points) {
  Numbers reach = points.radii;
  for (const CellGrid::Cell& leaf : points.grid.cells()) {
    for (std::uint32_t i = leaf.begin; leaf.children == 0 && i < leaf.end; ++i) {
      if (!points.end_radii.empty()) reach[i] = std::max(reach[i], points.end_radii[i]);
      if (points.end_positions.empty()) continue;
      const Eigen::Vector3f& end = points.end_positions[i];
      reach[i] += (end - end.cwiseMax(leaf.lower).cwiseMin(leaf.upper)).norm();
    }
  }
  return reach;
}

/// What finish() fills.
void check_finished(const SurfacePoints& points) {
  require_length("cell_reach", points.cell_reach.size(), points.grid.cells().size());
  require_range("cell_reach", points.cell_reach, 0, kLarge);
  const Numbers needed = detail::largest_in_cells(points.grid, reaches_out(points));
  for (std::size_t k = 0; k < needed.size(); ++k) {
    if (points.cell_reach[k] >= (1 - kReachError) * needed[k]) continue;
    throw Error(
        fmt::format("surface points: cell_reach[{}] is {}, less than the {} that its "
                    "points reach; call finish()",
                    k, points.cell_reach[k], needed[k]));
  }
  if (points.size() == 0 ||
      (points.radius > 0 && points.radius <= static_cast<double>(kLarge) &&
       points.smallest_radius > 0 && points.smallest_radius <= points.radius)) {
    return;
  }
  throw Error(fmt::format("surface points: radius is {} and smallest_radius {}; call finish()",
                          points.radius, points.smallest_radius));
}

}  // namespace

void check(const SurfacePoints& points) {
  const std::size_t n = points.size();
  check_numbers(points);
  check_vectors(points);
  check_segments(points.segments, n);
  check_edges(points.edges, n);
  if (points.eye) check_eye(*points.eye, n);
  if (points.kernel != Kernel::wyvill && points.kernel != Kernel::wendland) {
    throw Error(fmt::format("surface points: {} is no kernel; give wyvill or wendland",
                            static_cast<int>(points.kernel)));
  }
  check_finished(points);
}

}  // namespace palpate
