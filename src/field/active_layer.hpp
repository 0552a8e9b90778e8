#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "palpate/field/surface_points.hpp"

namespace palpate {

inline constexpr std::size_t kMostLayers = 64;  ///< that a patch is gathered from

/// One layer of points as it counts at the present moment.
struct ActiveLayer {
  const SurfacePoints* points = nullptr;
  int source = 0;
  double weight = 1;    ///< C_k
  double progress = 0;  ///< 0 at the points' start (A), 1 at their end (B)
  double rate = 0;      ///< d progress / dt, 1/s

  /// Patches that are gathered now can be advanced until progress is this; below `progress`: they
  /// cannot.
  double until = 0;
  double last_weight = 0;  ///< C_k then

  /// No R is below this, m; a point that it widens weighs as much less as it covers more.
  double least_radius = 0;
};

/// The position of a layer's point now, relative to `center` (world frame).
[[nodiscard]] inline Eigen::Vector3d position_now(const ActiveLayer& layer, std::uint32_t i,
                                                  const Eigen::Vector3d& center) noexcept {
  const SurfacePoints& points = *layer.points;
  Eigen::Vector3d position = points.grid.points()[i].cast<double>();
  if (!points.end_positions.empty()) {
    position += layer.progress * (points.end_positions[i].cast<double>() - position);
  }
  return position - (center - points.origin);
}

[[nodiscard]] Eigen::Vector3d normal_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// m/s
[[nodiscard]] Eigen::Vector3d velocity_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// a_i C_k now; C_k alone with `raw_weights`.
[[nodiscard]] double weight_now(const ActiveLayer& layer, std::uint32_t i,
                                bool raw_weights) noexcept;

/// The support radius of a layer's point now, m.
[[nodiscard]] double radius_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

[[nodiscard]] double confidence_now(const ActiveLayer& layer, std::uint32_t i) noexcept;
[[nodiscard]] double presence_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// Does a layer's point lie beside an edge at any time?
[[nodiscard]] inline bool has_edge(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const std::vector<std::uint32_t>& edges = layer.points->edges.of_point;
  return !edges.empty() && edges[i] != SurfacePoints::Edges::kNone;
}
/// The plane beyond it; share 0: there is none.
[[nodiscard]] SurfacePoints::EdgePlane edge_now(const ActiveLayer& layer, std::uint32_t i) noexcept;

/// Does a point count for nothing at any time (speckle)?
[[nodiscard]] inline bool weightless(const SurfacePoints& points, std::uint32_t i) noexcept {
  return points.density_weights[i] <= 0 &&
         (points.end_density_weights.empty() || points.end_density_weights[i] <= 0);
}

/// Do any of the points have a presence of their own?
[[nodiscard]] inline bool fades(const SurfacePoints& points) noexcept {
  return !points.presences.empty() || !points.end_presences.empty();
}

}  // namespace palpate
