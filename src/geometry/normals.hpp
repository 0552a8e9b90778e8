#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

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
};

/// Principal-component normals from all points within `radius` (m) of each, itself included.
/// @throws Error when the radius is not positive and finite.
[[nodiscard]] Normals estimate_normals(const CellGrid& grid, float radius);

/// The same within `times` times a radius for each point, in sorted order.
/// @throws Error as above, or when there are not as many radii as points.
[[nodiscard]] Normals estimate_normals(const CellGrid& grid, std::span<const float> radii,
                                       float times = 1);

/// Options of support radii.
struct SupportOptions {
  std::optional<double> multiple;  ///< m in R = m s; unset: support_multiple()
  double noise = 0;                ///< sigma_n, rms distance of raw points from the surface, m
  double footprint = 0;            ///< delta, root of the surface area per raw point, m;
                                   ///< 0: each point's own spacing
  double normal_error = 0.02;      ///< theta, wanted error of normals, rad
  double minimum = 0;              ///< no R below, m
  double most_spacings = 6;        ///< no R above, for noise's sake; more would cost time and shape
  double finest_shape = std::numeric_limits<double>::infinity();  ///< nor above this, m
};

/// m in R = m s: 2.5; 3 when the noise is above 0.15 s, 4 above 0.4 s (docs/method.md 5.3).
[[nodiscard]] double support_multiple(double noise, double spacing);

/// The R at which noise tilts normals by theta and no more: sqrt(3.2 sigma_n delta / theta)
/// (docs/method.md 5.3), m.
[[nodiscard]] double noise_radius(double noise, double footprint, double normal_error);

/// R_i = max(m s_i, the noise's R, minimum) for each of `spacings` (smooth
/// ones, as local_spacings() gives them), m. Where m is not given, one that suits the median
/// spacing is used for all points.
/// @throws Error when an option is negative, not a number, or without sense.
[[nodiscard]] std::vector<float> support_radii(std::span<const float> spacings,
                                               const SupportOptions& options = {});

}  // namespace palpate
