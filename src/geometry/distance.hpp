#pragma once

#include <Eigen/Core>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// Squared distances between points and from a point or box to a cell's box, in float, added in one
/// fixed order: float rounding is monotone, so a box is never farther than a point within it.
[[nodiscard]] inline float squared_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const float x = a.x() - b.x();
  const float y = a.y() - b.y();
  const float z = a.z() - b.z();
  return x * x + y * y + z * z;
}

[[nodiscard]] inline float gap(float lower_a, float upper_a, float lower_b, float upper_b) {
  return std::max(0.f, std::max(lower_a - upper_b, lower_b - upper_a));
}

/// Between the boxes [lower, upper] and the cell's.
[[nodiscard]] inline float squared_distance(const CellGrid::Cell& cell,
                                            const Eigen::Vector3f& lower,
                                            const Eigen::Vector3f& upper) {
  const float x = gap(cell.lower.x(), cell.upper.x(), lower.x(), upper.x());
  const float y = gap(cell.lower.y(), cell.upper.y(), lower.y(), upper.y());
  const float z = gap(cell.lower.z(), cell.upper.z(), lower.z(), upper.z());
  return x * x + y * y + z * z;
}

[[nodiscard]] inline float squared_distance(const CellGrid::Cell& cell,
                                            const Eigen::Vector3f& point) {
  return squared_distance(cell, point, point);
}

}  // namespace palpate::detail
