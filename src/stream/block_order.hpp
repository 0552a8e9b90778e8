// Declares the curve along which the blocks of an image stand.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate {

/// The blocks of an image along a Z-order curve, on which neighbours in the image stay near each
/// other: points in this order are indexed without sorting.
struct BlockOrder {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint32_t> blocks;  ///< at each index of the curve: the block's row-by-row number
  std::vector<std::uint32_t> codes;   ///< of these, where on the curve, rising; two bits a level
  std::vector<std::uint32_t> indices;  ///< of each block: where it is in that order

  [[nodiscard]] std::size_t size() const { return blocks.size(); }
};

/// Where on the curve the block stands.
[[nodiscard]] std::uint32_t curve_code(int column, int row);

/// @param columns, rows: 0 to 32768.
[[nodiscard]] BlockOrder make_block_order(int columns, int rows);

/// Calls visit(block) for those around a block, row by row.
template <class Visit>
void visit_beside(int columns, int rows, std::size_t block, const Visit& visit) {
  const int u = static_cast<int>(block) % columns;
  const int v = static_cast<int>(block) / columns;
  for (int y = std::max(0, v - 1); y <= std::min(rows - 1, v + 1); ++y) {
    for (int x = std::max(0, u - 1); x <= std::min(columns - 1, u + 1); ++x) {
      const auto other = static_cast<std::size_t>(y * columns + x);
      if (other != block) visit(other);
    }
  }
}

}  // namespace palpate
