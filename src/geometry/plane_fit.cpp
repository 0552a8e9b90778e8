#include "geometry/plane_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace palpate::detail {
namespace {

constexpr int kNewtonSteps = 12;
constexpr double kDefined = 1e-12;  // smallest share of the trace that defines a direction

// The smallest root of x^3 - x^2 + c x - d, the characteristic polynomial at trace 1. From zero on
// up to that root the polynomial is concave and rises, so Newton's steps never pass it.
double smallest_root(double c, double d) {
  double x = 0;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const double slope = c + x * (3 * x - 2);
    if (!(slope > 1e-15)) break;
    const double step = (d - x * (c + x * (x - 1))) / slope;
    if (!(step > 1e-16)) break;
    x += step;
  }
  return std::min(x, 1. / 3);
}

// The direction that all rows of the singular matrix are normal to: the longest of the rows' cross
// products. Zero if the rows are parallel.
Eigen::Vector3d null_direction(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = a.cross(b);
  const Eigen::Vector3d bc = b.cross(c);
  const Eigen::Vector3d ca = c.cross(a);
  const double length_ab = ab.squaredNorm();
  const double length_bc = bc.squaredNorm();
  const double length_ca = ca.squaredNorm();
  const double longest = std::max({length_ab, length_bc, length_ca});
  if (!(longest > kDefined * kDefined)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d& direction = longest == length_ab ? ab : (longest == length_bc ? bc : ca);
  return direction / std::sqrt(longest);
}

}  // namespace

PlaneFit fit_plane(const Symmetric& covariance) noexcept {
  const double trace = covariance.xx + covariance.yy + covariance.zz;
  if (!(trace > 0) || !std::isfinite(1 / trace)) return {};
  const double xx = covariance.xx / trace;
  const double xy = covariance.xy / trace;
  const double xz = covariance.xz / trace;
  const double yy = covariance.yy / trace;
  const double yz = covariance.yz / trace;
  const double zz = covariance.zz / trace;
  const double minors = xx * yy - xy * xy + (xx * zz - xz * xz) + (yy * zz - yz * yz);
  const double determinant =
      xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  const double smallest = smallest_root(minors, determinant);
  // The other two from their sum and product.
  const double half_sum = 0.5 * (1 - smallest);
  const double product = minors - smallest * (1 - smallest);
  const double half_gap = std::sqrt(std::max(0., half_sum * half_sum - product));
  const double middle = std::max(smallest, half_sum - half_gap);
  PlaneFit fit;
  fit.normal =
      null_direction({xx - smallest, xy, xz}, {xy, yy - smallest, yz}, {xz, yz, zz - smallest});
  fit.smallest = trace * smallest;
  fit.middle = trace * middle;
  fit.largest = trace * (half_sum + half_gap);
  return fit;
}

}  // namespace palpate::detail
