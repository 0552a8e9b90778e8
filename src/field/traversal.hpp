#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "field/active_layer.hpp"

namespace palpate {

/// The cells still to visit in a depth-first walk through an index.
class CellStack {
 public:
  explicit CellStack(const SurfacePoints& points) noexcept {
    if (!points.grid.cells().empty()) cells_[size_++] = 0;
  }

  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::uint32_t pop() noexcept { return cells_[--size_]; }

  void push(std::uint32_t cell) noexcept { cells_[size_++] = cell; }

  /// The first child is visited next: points come in sorted order.
  void push_children(const CellGrid::Cell& cell) noexcept {
    for (std::uint32_t k = cell.children; k-- > 0;) cells_[size_++] = cell.first_child + k;
  }

 private:
  std::array<std::uint32_t, CellGrid::kMaxStack> cells_;
  std::size_t size_ = 0;
};

/// Tells which cells come near a place, in single precision and on the safe side: what rounding
/// takes away is given back by a little slack.
class CellTest {
 public:
  /// x relative to the points' origin, m.
  explicit CellTest(const Eigen::Vector3d& x) noexcept
      : x_(x.cast<float>()), slack_(4e-7f * x_.cwiseAbs().maxCoeff()) {}

  /// False only when the cell's box is certainly further away than `reach`, m.
  [[nodiscard]] bool near(const CellGrid::Cell& cell, double reach) const noexcept {
    const float limit = static_cast<float>(reach) * (1 + 1e-6f) + slack_;
    return squared_distance(cell) <= limit * limit;
  }

  /// To the cell's box, rounded, m^2.
  [[nodiscard]] float squared_distance(const CellGrid::Cell& cell) const noexcept {
    float squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float below = cell.lower[axis] - x_[axis];
      const float above = x_[axis] - cell.upper[axis];
      const float outside = std::max(std::max(below, above), 0.0f);
      squared += outside * outside;
    }
    return squared;
  }

 private:
  Eigen::Vector3f x_;
  float slack_;
};

/// Tells which points certainly stay away from a place on all of their way: in single precision and
/// on the safe side, since most of a cell's points do.
class PointTest {
 public:
  /// x relative to the points' origin, m.
  PointTest(const SurfacePoints& points, const Eigen::Vector3d& x) noexcept
      : starts_(points.grid.points().data()),
        ends_(points.end_positions.empty() ? starts_ : points.end_positions.data()),
        x_(x.cast<float>()),
        slack_(4e-7f * x_.cwiseAbs().maxCoeff()) {}

  /// True only when the i-th point is certainly further away than `reach`, m, at any time.
  [[nodiscard]] bool far(std::uint32_t i, float reach) const noexcept {
    const Eigen::Vector3f from = starts_[i] - x_;
    const Eigen::Vector3f way = ends_[i] - starts_[i];
    const float limit = (reach + 0.5f * std::sqrt(way.squaredNorm())) * (1 + 1e-5f) + slack_;
    return (from + 0.5f * way).squaredNorm() > limit * limit;
  }

 private:
  const Eigen::Vector3f* starts_;
  const Eigen::Vector3f* ends_;
  Eigen::Vector3f x_;
  float slack_;
};

/// The largest support radius of a layer's point at any time, m.
[[nodiscard]] inline float largest_radius(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const float start = std::max(points.radii[i], static_cast<float>(layer.least_radius));
  return points.end_radii.empty() ? start : std::max(start, points.end_radii[i]);
}

}  // namespace palpate
