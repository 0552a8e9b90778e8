#pragma once

#include <cstddef>

#include "geometry/parallel.hpp"
#include "palpate/depth/camera_model.hpp"

namespace palpate::depth {

/// Where the 2x2 blocks of an undistorted image look: the block (column, row) looks along
/// (x(column), y(row), 1).
struct BlockGrid {
  int columns = 0;
  int rows = 0;
  double x0 = 0;  ///< of column 0
  double y0 = 0;
  double step_x = 0;  ///< from column to column
  double step_y = 0;

  [[nodiscard]] double x(double column) const { return x0 + column * step_x; }
  [[nodiscard]] double y(double row) const { return y0 + row * step_y; }
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(columns) * rows; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * columns + column;
  }

  bool operator==(const BlockGrid&) const = default;
};

/// An odd last column or row of pixels belongs to no block.
[[nodiscard]] inline BlockGrid block_grid(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return {camera.width / 2,    camera.height / 2, (0.5 - p.cx) / p.fx,
          (0.5 - p.cy) / p.fy, 2 / p.fx,          2 / p.fy};
}

/// Calls body(row) for each row, on several threads: see parallel_ranges().
template <class Body>
void for_rows(const BlockGrid& grid, const Body& body) {
  constexpr std::size_t kRowsAtATime = 8;
  detail::parallel_ranges(static_cast<std::size_t>(grid.rows), kRowsAtATime,
                          [&](std::size_t row, std::size_t end) {
                            for (; row < end; ++row) body(static_cast<int>(row));
                          });
}

}  // namespace palpate::depth
