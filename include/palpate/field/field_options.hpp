#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

/// The paper's two compactly supported weights (section III-A).
enum class Kernel { wyvill, wendland };

/// A weight w and its slope g = (dw/dr) / r, both as functions of q = r^2, r = |x - p| / R.
/// grad w = g (x - p) / R^2, which is well defined at r = 0 too. Both are 0 for r >= 1.
struct KernelValue {
  double w = 0;
  double g = 0;
};

/// Eq. (1), factored: with s = 1 - q it is s^2 (5 + 4 s) / 9. No square root.
[[nodiscard]] constexpr KernelValue wyvill(double q) noexcept {
  const double s = std::max(0.0, 1 - q);
  return {s * s * (5 + 4 * s) / 9, -s * (5 + 6 * s) * (4. / 9)};
}

/// Eq. (2).
[[nodiscard]] inline KernelValue wendland(double q) noexcept {
  const double r = std::sqrt(q);
  const double s = std::max(0.0, 1 - r);
  return {s * s * s * s * (4 * r + 1), -20 * s * s * s};
}

[[nodiscard]] inline KernelValue evaluate(Kernel kernel, double q) noexcept {
  return kernel == Kernel::wyvill ? wyvill(q) : wendland(q);
}

/// The level at which the density-normalised weight sum of a plane stands at a height of `eta`
/// support radii, 1 at 0 and 0 from 1 on: the metaball's threshold for an offset of eta R
/// (docs/method.md 2.1).
[[nodiscard]] double plane_threshold(Kernel kernel, double eta) noexcept;

/// d plane_threshold / d eta.
[[nodiscard]] double plane_threshold_slope(Kernel kernel, double eta) noexcept;

/// The inverse of plane_threshold, by bisection. Not for the servo step.
[[nodiscard]] double plane_offset(Kernel kernel, double threshold) noexcept;

/// The implicit surfaces that points can be turned into.
enum class FieldKind {
  balanced,  ///< mean of point-set surface and IMLS; our default (docs/method.md 2.4)
  pointset,  ///< the paper's point-set surface, eqs. (5)-(7)
  metaball,  ///< the paper's metaball surface, eq. (3), on density-normalised weights
};

/// Which vector stands for the gradient.
enum class GradientKind {
  exact,    ///< of the function as evaluated
  normal,   ///< the mean normal n(x): eq. (8), `pointset` of the preset `paper` only
  printed,  ///< eq. (4) as printed, which points inward: to show that, never to be felt
};

/// How points become a surface. The defaults are ours; paper_field() gives the paper's.
struct FieldOptions {
  FieldKind kind = FieldKind::balanced;
  Kernel kernel = Kernel::wyvill;
  GradientKind gradient = GradientKind::exact;
  double threshold = 0.4;        ///< metaball level T', of the (united) weight sum
  double minimum_support = 0.3;  ///< Wmin: the surface ends where the weight sum falls below it
  double tool_radius = 0;        ///< radius of the proxy's ball, m; the surface is pushed out by it
  /// Cap at Wmin, fill acute creases, and blend to the metaball where normals are unsure.
  bool capped = true;
  /// Edges and creases are sharp where points know what they meet (SurfacePoints::edges);
  /// `balanced` with the exact gradient only.
  bool sharp_edges = true;
  bool raw_weights = false;     ///< ignore density weights (the paper)
  bool nearest_radius = false;  ///< use the R of the point nearest to the proxy for all (the paper)

  bool operator==(const FieldOptions&) const = default;
};

/// @throws Error when an option is out of its range.
void check(const FieldOptions& options);

/// The paper's field: raw weights, T = 0.5, R of the nearest point, no cap.
[[nodiscard]] FieldOptions paper_field(FieldKind kind = FieldKind::metaball);

}  // namespace palpate
