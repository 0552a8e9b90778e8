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

/// Three numbers in one register: compilers turn a scalar maximum into a branch, and whether boxes
/// overlap cannot be foretold.
struct Lanes {
  typedef float Floats __attribute__((vector_size(16)));

  Floats v;

  explicit Lanes(const Floats& floats) : v(floats) {}
  explicit Lanes(const Eigen::Vector3f& p) : v{p.x(), p.y(), p.z(), 0.f} {}

  [[nodiscard]] Lanes operator-(const Lanes& other) const { return Lanes(v - other.v); }
  [[nodiscard]] Lanes larger(const Lanes& other) const { return Lanes(v < other.v ? other.v : v); }
  [[nodiscard]] float squared_norm() const {
    const Floats squares = v * v;
    return squares[0] + squares[1] + squares[2];
  }
};

/// Between the boxes [lower, upper] and the cell's.
[[nodiscard]] inline float squared_distance(const CellGrid::Cell& cell,
                                            const Eigen::Vector3f& lower,
                                            const Eigen::Vector3f& upper) {
  const Lanes below = Lanes(cell.lower) - Lanes(upper);
  const Lanes above = Lanes(lower) - Lanes(cell.upper);
  return below.larger(above).larger(Lanes(Lanes::Floats{})).squared_norm();
}

[[nodiscard]] inline float squared_distance(const CellGrid::Cell& cell,
                                            const Eigen::Vector3f& point) {
  return squared_distance(cell, point, point);
}

}  // namespace palpate::detail
