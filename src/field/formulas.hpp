// The closed formulas that fields share: kernels, the level of a plane, agreement, smooth step.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/field/field_options.hpp"

namespace palpate {

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

/// Eq. (1), whatever kernel a field has, of a squared distance, m^2; `reach`: R, m.
[[nodiscard]] inline double weight_within(float squared, float reach) noexcept {
  return wyvill(static_cast<double>(squared / (reach * reach))).w;
}

[[nodiscard]] inline KernelValue evaluate(Kernel kernel, double q) noexcept {
  return kernel == Kernel::wyvill ? wyvill(q) : wendland(q);
}

/// 1 / integral of w(r) r dr over [0, 1] (docs/method.md 2.1).
[[nodiscard]] constexpr double plane_norm(Kernel kernel) noexcept {
  return kernel == Kernel::wyvill ? 27. / 4 : 14;
}

/// The integral of a kernel over a plane, for R = 1: times R^2 over the area of a point it is the
/// sum of raw weights on a plane that goes on on all sides.
[[nodiscard]] constexpr double plane_integral(Kernel kernel) noexcept {
  return 2 * std::numbers::pi / plane_norm(kernel);
}

/// The level at which the density-normalised weight sum of a plane stands at a height of `eta`
/// support radii, 1 at 0 and 0 from 1 on: the metaball's threshold for an offset of eta R
/// (docs/method.md 2.1).
[[nodiscard]] double plane_threshold(Kernel kernel, double eta) noexcept;

/// d plane_threshold / d eta.
[[nodiscard]] double plane_threshold_slope(Kernel kernel, double eta) noexcept;

/// The inverse of plane_threshold, by bisection. Not for the servo step.
[[nodiscard]] double plane_offset(Kernel kernel, double threshold) noexcept;

/// How far two points' normals agree on what is outside, -1 ... 1: n_p, mirrored by the plane
/// halfway between p and q, times n_q, as if an arc joined the two; their plain product where both
/// points lie on one plane within `tolerance` (m). `offset`: from p to q, or back, m.
[[nodiscard]] inline float agreement(const Eigen::Vector3f& n_p, const Eigen::Vector3f& n_q,
                                     const Eigen::Vector3f& offset, float tolerance) noexcept {
  const float by_p = n_p.dot(offset);
  const float by_q = n_q.dot(offset);
  const float straight = n_p.dot(n_q);
  const float squared = offset.squaredNorm();
  const bool one_plane = std::abs(by_p) <= tolerance && std::abs(by_q) <= tolerance;
  return one_plane || !(squared > 0) ? straight : straight - 2 * by_p * by_q / squared;
}

/// How far a gate has opened, 0 to 1, with its derivative.
struct SmoothStep {
  double value = 0;
  double slope = 0;
};

/// u^2 (3 - 2u) of u = clamp((x - from) / width, 0, 1): the gates between one surface and another.
[[nodiscard]] inline SmoothStep smooth_step(double x, double from, double width) noexcept {
  const double u = std::clamp((x - from) / width, 0.0, 1.0);
  return {u * u * (3 - 2 * u), 6 * u * (1 - u) / width};
}

/// A column of surface points as it is at the end of their path: that of the start where it does
/// not change.
template <class Column>
[[nodiscard]] const Column& newest(const Column& start, const Column& end) {
  return end.empty() ? start : end;
}

}  // namespace palpate
