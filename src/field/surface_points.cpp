// Completes and checks surface points.

#include "palpate/field/surface_points.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/neighborhoods.hpp"
#include "palpate/base/error.hpp"
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

void require_length(const char* column, std::size_t length, std::size_t expected) {
  if (length == expected) return;
  throw Error(
      fmt::format("surface points: {} has {} entries instead of {}; fill it, then call finish()",
                  column, length, expected));
}

void require_range(const char* column, const std::vector<float>& values, float low, float high) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= low && values[i] <= high) continue;
    throw Error(fmt::format("surface points: {}[{}] is {}; it must lie between {} and {}", column,
                            i, values[i], low, high));
  }
}

void require_finite(const char* column, const std::vector<Eigen::Vector3f>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].allFinite()) continue;
    throw Error(fmt::format("surface points: {}[{}] is not finite", column, i));
  }
}

void check_lengths(const SurfacePoints& points) {
  const std::size_t n = points.size();
  const auto optional = [n](std::size_t length) { return length == 0 ? 0 : n; };
  require_length("radii", points.radii.size(), n);
  require_length("density_weights", points.density_weights.size(), n);
  require_length("confidences", points.confidences.size(), n);
  require_length("normals", points.normals.size(), optional(points.normals.size()));
  require_length("materials", points.materials.size(), optional(points.materials.size()));
  require_length("colors", points.colors.size(), optional(points.colors.size()));
  require_length("presences", points.presences.size(), optional(points.presences.size()));
  require_length("end_presences", points.end_presences.size(),
                 optional(points.end_presences.size()));
  require_length("end_positions", points.end_positions.size(),
                 optional(points.end_positions.size()));
  require_length("end_normals", points.end_normals.size(), optional(points.end_normals.size()));
  require_length("end_density_weights", points.end_density_weights.size(),
                 optional(points.end_density_weights.size()));
  require_length("end_radii", points.end_radii.size(), optional(points.end_radii.size()));
  require_length("end_confidences", points.end_confidences.size(),
                 optional(points.end_confidences.size()));
  require_length("edges.of_point", points.edges.of_point.size(),
                 optional(points.edges.of_point.size()));
  require_length("edges.end", points.edges.end.size(),
                 points.edges.end.empty() ? 0 : points.edges.start.size());
  require_length("cell_reach", points.cell_reach.size(), points.grid.cells().size());
}

void require_edges(const char* column, const std::vector<SurfacePoints::EdgePlane>& edges) {
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const SurfacePoints::EdgePlane& edge = edges[k];
    if (edge.normal.allFinite() && std::isfinite(edge.height) && std::abs(edge.share) <= 1)
      continue;
    throw Error(
        fmt::format("surface points: {}[{}] is not finite, or its share {} is not within "
                    "-1 and 1",
                    column, k, edge.share));
  }
}

void check_edges(const SurfacePoints::Edges& edges) {
  for (std::size_t i = 0; i < edges.of_point.size(); ++i) {
    const std::uint32_t edge = edges.of_point[i];
    if (edge < edges.start.size() || edge == SurfacePoints::Edges::kNone) continue;
    throw Error(fmt::format("surface points: edges.of_point[{}] is {}, but there are only {} edges",
                            i, edge, edges.start.size()));
  }
  require_edges("edges.start", edges.start);
  require_edges("edges.end", edges.end);
}

}  // namespace

Box SurfacePoints::bounds() const {
  if (grid.cells().empty()) return {};
  const CellGrid::Cell& root = grid.cells().front();
  return {origin + root.lower.cast<double>(), origin + root.upper.cast<double>()};
}

void check(const SurfacePoints& points) {
  check_lengths(points);
  constexpr float kLarge = std::numeric_limits<float>::max();  // m or no unit: any finite value
  require_range("radii", points.radii, std::numeric_limits<float>::min(), kLarge);
  require_range("density_weights", points.density_weights, 0, kLarge);
  require_range("end_density_weights", points.end_density_weights, 0, kLarge);
  require_range("end_radii", points.end_radii, std::numeric_limits<float>::min(), kLarge);
  require_range("confidences", points.confidences, 0, 1);
  require_range("end_confidences", points.end_confidences, 0, 1);
  require_range("materials", points.materials, 0, 1);
  require_range("presences", points.presences, 0, 1);
  require_range("end_presences", points.end_presences, 0, 1);
  require_finite("normals", points.normals);
  require_finite("end_normals", points.end_normals);
  require_finite("end_positions", points.end_positions);
  check_edges(points.edges);
  if (!points.origin.allFinite()) throw Error("surface points: the origin is not finite");
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
