#include "palpate/geometry/normals.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "geometry/neighborhoods.hpp"
#include "geometry/plane_fit.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using Moments = simd::Row[simd::kMoments];

constexpr float kFewestPoints = 5;  // below: no confidence

struct Neighborhood {
  float count = 0;
  detail::Symmetric covariance;  // m^2
};

// From sums about the point itself: small numbers, so float sums keep their digits.
Neighborhood neighborhood_of(const Moments& moments, std::size_t query) {
  const auto row = [&](std::size_t k) { return static_cast<double>(moments[k][query]); };
  const double n = row(0);
  const Eigen::Vector3d mean(row(1) / n, row(2) / n, row(3) / n);
  return {moments[0][query],
          {.xx = row(4) / n - mean.x() * mean.x(),
           .xy = row(5) / n - mean.x() * mean.y(),
           .xz = row(6) / n - mean.x() * mean.z(),
           .yy = row(7) / n - mean.y() * mean.y(),
           .yz = row(8) / n - mean.y() * mean.z(),
           .zz = row(9) / n - mean.z() * mean.z()}};
}

// 0 at or below `from`, 1 at or above `to`.
double ramp(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0., 1.);
}

float confidence_of(float count, const detail::PlaneFit& fit) {
  if (count < kFewestPoints || !(fit.middle > 0)) return 0;
  const double not_a_line = ramp(fit.middle / fit.largest, 0.03, 0.07);
  const double not_a_volume = 1 - ramp(fit.smallest / fit.middle, 0.4, 0.6);
  return static_cast<float>(not_a_line * not_a_volume);
}

void write(const Neighborhood& neighborhood, std::size_t i, Normals& result) {
  const detail::PlaneFit fit = detail::fit_plane(neighborhood.covariance);
  const double n = static_cast<double>(neighborhood.count);
  const bool defined = n >= 3 && !fit.normal.isZero();
  result.normals[i] = defined ? Eigen::Vector3f(fit.normal.cast<float>()) : Eigen::Vector3f::Zero();
  result.confidences[i] = defined ? confidence_of(neighborhood.count, fit) : 0;
  result.residuals[i] =
      n > 3 ? static_cast<float>(std::sqrt(std::max(0., fit.smallest) * n / (n - 3))) : 0;
}

void check_radius(float radius) {
  if (!(radius > 0) || !std::isfinite(radius)) {
    throw Error(fmt::format("normals: a radius of {} m; it must be positive and finite", radius));
  }
}

}  // namespace

Normals estimate_normals(const CellGrid& grid, float radius) {
  check_radius(radius);
  return estimate_normals(grid, std::vector<float>(grid.size(), radius));
}

Normals estimate_normals(const CellGrid& grid, std::span<const float> radii) {
  if (radii.size() != grid.size()) {
    throw Error(fmt::format("normals: {} radii for {} points; give one for each", radii.size(),
                            grid.size()));
  }
  for (const float radius : radii) check_radius(radius);
  Normals result;
  result.normals.resize(grid.size());
  result.confidences.resize(grid.size());
  result.residuals.resize(grid.size());
  const detail::Columns columns(grid);
  std::vector<float> squared_radii = detail::make_column(grid.size());
  std::transform(radii.begin(), radii.end(), squared_radii.begin(), [](float r) { return r * r; });
  detail::for_each_neighborhood(
      grid, {.of_points = radii, .of_cells = {}},
      [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
        Moments moments;
        simd::best_joins().moments(columns.join(first, runs), squared_radii.data(), moments);
        for (std::uint32_t q = 0; q < count; ++q) {
          write(neighborhood_of(moments, q), first + q, result);
        }
      });
  return result;
}

}  // namespace palpate
