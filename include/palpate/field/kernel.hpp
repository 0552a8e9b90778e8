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
/// (docs/architecture.md, Words).
[[nodiscard]] double plane_threshold(Kernel kernel, double eta) noexcept;

/// d plane_threshold / d eta.
[[nodiscard]] double plane_threshold_slope(Kernel kernel, double eta) noexcept;

/// The inverse of plane_threshold, by bisection. Not for the servo step.
[[nodiscard]] double plane_offset(Kernel kernel, double threshold) noexcept;

}  // namespace palpate
