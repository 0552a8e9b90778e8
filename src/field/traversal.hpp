#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "palpate/field/surface_points.hpp"

namespace palpate {

/// The cells still to visit in a depth-first walk through an index.
class CellStack {
 public:
  explicit CellStack(const SurfacePoints& points) noexcept {
    if (!points.grid.cells().empty()) cells_[size_++] = 0;
  }

  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::uint32_t pop() noexcept { return cells_[--size_]; }

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
    float squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float below = cell.lower[axis] - x_[axis];
      const float above = x_[axis] - cell.upper[axis];
      const float outside = std::max(std::max(below, above), 0.0f);
      squared += outside * outside;
    }
    const float limit = static_cast<float>(reach) * (1 + 1e-6f) + slack_;
    return squared <= limit * limit;
  }

 private:
  Eigen::Vector3f x_;
  float slack_;
};

}  // namespace palpate
