#pragma once

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

}  // namespace palpate
