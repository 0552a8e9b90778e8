#pragma once

#include <algorithm>
#include <cstddef>

#include "depth/blocks.hpp"
#include "depth/simd/fits.hpp"
#include "geometry/parallel.hpp"

namespace palpate::depth {

/// Squares of blocks. The block in the middle of each looks for a face, and blocks take a face of
/// their own tile or of those around.
struct FaceTiles {
  int side;    ///< blocks
  int around;  ///< tiles to each side whose faces a block may take
  int columns = 0;
  int first_row = 0;  ///< rows of tiles with rows of the table
  int end_row = 0;

  /// @return tiles up to the last row
  std::size_t set(const BlockGrid& grid, const simd::WindowTable& table) {
    columns = (grid.columns + side - 1) / side;
    first_row = table.first_row / side;
    end_row = (table.first_row + table.rows + side - 1) / side;
    return index(0, end_row);
  }

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * columns + column;
  }

  /// Calls body(row of tiles) on several threads, `at_a_time` rows each.
  template <class Body>
  void for_rows(std::size_t at_a_time, const Body& body) const {
    detail::parallel_each(static_cast<std::size_t>(end_row - first_row), at_a_time,
                          [&](std::size_t row) { body(first_row + static_cast<int>(row)); });
  }

  /// Calls look(index, column, row) for the block in the middle of each tile of a row.
  template <class Look>
  void each_middle(const BlockGrid& grid, int tile_row, const Look& look) const {
    const int row = std::min(tile_row * side + side / 2, grid.rows - 1);
    for (int tile = 0; tile < columns; ++tile) {
      look(index(tile, tile_row), std::min(tile * side + side / 2, grid.columns - 1), row);
    }
  }

  /// Calls take(index) for the tiles around one and for itself.
  template <class Take>
  void each_near(int tile, int tile_row, const Take& take) const {
    const int bottom = std::min(tile_row + around, end_row - 1);
    const int right = std::min(tile + around, columns - 1);
    for (int row = std::max(tile_row - around, first_row); row <= bottom; ++row) {
      for (int column = std::max(tile - around, 0); column <= right; ++column) {
        take(index(column, row));
      }
    }
  }

  /// Calls take(column, row) for the blocks of a tile.
  template <class Take>
  void each_block(const BlockGrid& grid, int tile, int tile_row, const Take& take) const {
    const int bottom = std::min((tile_row + 1) * side, grid.rows);
    const int right = std::min((tile + 1) * side, grid.columns);
    for (int row = tile_row * side; row < bottom; ++row) {
      for (int column = tile * side; column < right; ++column) take(column, row);
    }
  }
};

}  // namespace palpate::depth
