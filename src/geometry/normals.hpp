#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "geometry/neighborhood_graph.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Planes fitted to neighbourhoods, one for each point in sorted order.
struct Normals {
  /// Unit length, sign arbitrary; zero where fewer than three points or points in a line leave it
  /// undefined.
  std::vector<Eigen::Vector3f> normals;

  /// 0-1: is there a surface that the normal belongs to? (docs/method.md 5.5.) 0 for fewer
  /// than five points, for a line (middle / largest eigenvalue < 0.03, full from 0.07 on) and for a
  /// volume (smallest / middle > 0.6, full from 0.4 down). Ramps stand for the thresholds 0.05 and
  /// 0.5, so that noise on either side of one does not make the surface flicker.
  std::vector<float> confidences;

  /// Rms distance of the neighbours from the plane, m; unbiased (n - 3 degrees of freedom), 0 for
  /// three points or fewer.
  std::vector<float> residuals;

  /// How far the neighbours' mean is from the point, of the radius looked within; 0 where they lie
  /// evenly around.
  std::vector<float> asides;
};

/// Principal-component normals from all points within `radius` (m) of each, itself included.
/// @throws Error when the radius is not positive and finite.
[[nodiscard]] Normals estimate_normals(const CellGrid& grid, float radius);

/// The same within a radius for each point, in sorted order.
/// @throws Error as above, or when there are not as many radii as points.
[[nodiscard]] Normals estimate_normals(const CellGrid& grid, const std::vector<float>& radii);

/// The same within `times` times the radii, which the graph holds.
/// @throws Error as above.
[[nodiscard]] Normals estimate_normals(const detail::NeighborhoodGraph& graph,
                                       std::span<const float> radii, float times = 1);

}  // namespace palpate
