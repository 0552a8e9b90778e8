#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace palpate {

/// How support radii are chosen.
struct SupportOptions {
  std::optional<double> multiple;  ///< m in R = m s; unset: support_multiple()
  double noise = 0;                ///< sigma_n, rms distance of raw points from the surface, m
  double footprint = 0;            ///< delta, root of the surface area per raw point, m;
                                   ///< 0: each point's own spacing
  double normal_error = 0.02;      ///< theta, wanted error of normals, rad
  double minimum = 0;              ///< no R below, m
  double most_spacings = 6;        ///< no R above, for noise's sake; more would cost time and shape
  double finest_shape = std::numeric_limits<double>::infinity();  ///< likewise, m
};

/// m in R = m s: 2.5; 3 when the noise is above 0.15 s, 4 above 0.4 s (algorithm.md section 4).
[[nodiscard]] double support_multiple(double noise, double spacing);

/// The R at which noise tilts normals by theta and no more: sqrt(3.2 sigma_n delta / theta)
/// (field_choice.md section 5), m.
[[nodiscard]] double noise_radius(double noise, double footprint, double normal_error);

/// R_i = max(m s_i, the noise's R, minimum) for each of `spacings` (smooth
/// ones, as local_spacings() gives them), m. Where m is not given, one that suits the median
/// spacing is used for all points.
/// @throws Error when an option is negative, not a number, or without sense.
[[nodiscard]] std::vector<float> support_radii(std::span<const float> spacings,
                                               const SupportOptions& options = {});

}  // namespace palpate
