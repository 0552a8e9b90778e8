#pragma once

#include <cstdint>
#include <vector>

namespace palpate {

/// The blocks of an image along a Z-order curve, on which neighbours in the image stay near each
/// other: points in this order are indexed without sorting.
struct BlockOrder {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint32_t> blocks;  ///< in the curve's order; row by row numbers
  std::vector<std::uint32_t> codes;   ///< where on the curve, rising; two bits a level

  [[nodiscard]] std::size_t size() const { return blocks.size(); }
};

/// @param columns, rows: 0 to 32768.
[[nodiscard]] BlockOrder make_block_order(int columns, int rows);

}  // namespace palpate
