// Fits a plane to each point's neighbours; its normal and planarity become normal and confidence.
#include "geometry/normals.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "geometry/neighborhood_graph.hpp"
#include "geometry/parallel.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

constexpr float kFewestPoints = 5;  // points; fewer give no confidence (judgement)

// 0 at or below `from`, 1 at or above `to`.
double ramp(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0., 1.);
}

float confidence_of(float count, const simd::Planes& planes, std::size_t query) {
  const double middle = planes.middle[query];
  if (count < kFewestPoints || !(middle > 0)) return 0;
  const double not_a_line = ramp(middle / planes.largest[query], 0.03, 0.07);
  const double not_a_volume = 1 - ramp(planes.smallest[query] / middle, 0.4, 0.6);
  return static_cast<float>(not_a_line * not_a_volume);
}

void write(float count, const simd::Planes& planes, std::size_t query, std::size_t i,
           Normals& result) {
  const Eigen::Vector3d normal(planes.normal_x[query], planes.normal_y[query],
                               planes.normal_z[query]);
  if (count < 3 || normal.isZero()) return;
  result.normals[i] = normal.cast<float>();
  result.confidences[i] = confidence_of(count, planes, query);
  if (count <= 3) return;
  const auto n = static_cast<double>(count);
  result.residuals[i] = static_cast<float>(std::sqrt(planes.smallest[query] * n / (n - 3)));
}

void check_radius(float radius) {
  if (!(radius > 0) || !std::isfinite(radius)) {
    throw Error(fmt::format("normals: the radius is {} m; it must be positive and finite", radius));
  }
}

void check(const CellGrid& grid, std::span<const float> radii, float times) {
  if (radii.size() != grid.size()) {
    throw Error(fmt::format("normals: {} radii for {} points; give one for each", radii.size(),
                            grid.size()));
  }
  for (const float radius : radii) check_radius(times * radius);
}

}  // namespace

Normals estimate_normals(const CellGrid& grid, float radius) {
  check_radius(radius);
  return estimate_normals(grid, std::vector<float>(grid.size(), radius));
}

Normals estimate_normals(const CellGrid& grid, const std::vector<float>& radii) {
  check(grid, radii, 1);
  return estimate_normals(detail::NeighborhoodGraph(grid, radii), radii);
}

Normals estimate_normals(const detail::NeighborhoodGraph& graph, std::span<const float> radii,
                         float times) {
  const CellGrid& grid = graph.grid();
  check(grid, radii, times);
  Normals result;
  result.normals.resize(grid.size(), Eigen::Vector3f::Zero());
  result.confidences.resize(grid.size(), 0);
  result.residuals.resize(grid.size(), 0);
  result.asides.resize(grid.size(), 0);
  const simd::JoinFunctions& joins = simd::best_joins();
  graph.for_each_row([&](const detail::NeighborRow& row) {
    simd::Row moments[simd::kMoments];
    simd::Planes planes;
    simd::Row squared_radii = {};
    std::transform(radii.begin() + row.first, radii.begin() + row.first + row.count, squared_radii,
                   [times](float r) { return times * r * (times * r); });
    joins.moments(row.join(grid), squared_radii, moments);
    joins.planes(moments, &planes);
    for (std::uint32_t q = 0; q < row.count; ++q) {
      const std::uint32_t i = row.first + q;
      write(moments[0][q], planes, q, i, result);
      const Eigen::Vector3f sum(moments[1][q], moments[2][q], moments[3][q]);
      result.asides[i] = sum.norm() / (moments[0][q] * times * radii[i]);
    }
  });
  return result;
}

}  // namespace palpate
