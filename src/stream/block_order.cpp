// Orders the blocks of an image.
#include "stream/block_order.hpp"

#include <utility>

namespace palpate {
namespace {

// Puts a zero bit between any two of the lower 16 bits.
std::uint32_t spread(std::uint32_t v) {
  v = (v | (v << 8)) & 0x00FF00FF;
  v = (v | (v << 4)) & 0x0F0F0F0F;
  v = (v | (v << 2)) & 0x33333333;
  return (v | (v << 1)) & 0x55555555;
}

}  // namespace

std::uint32_t curve_code(int column, int row) {
  return spread(static_cast<std::uint32_t>(row)) << 1 | spread(static_cast<std::uint32_t>(column));
}

BlockOrder make_block_order(int columns, int rows) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // code, block
  pairs.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      pairs.emplace_back(curve_code(u, v), static_cast<std::uint32_t>(v * columns + u));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  BlockOrder order{.columns = columns, .rows = rows, .blocks = {}, .codes = {}, .indices = {}};
  order.indices.resize(pairs.size());
  for (const auto& [code, block] : pairs) {
    order.indices[block] = static_cast<std::uint32_t>(order.blocks.size());
    order.blocks.push_back(block);
    order.codes.push_back(code);
  }
  return order;
}

}  // namespace palpate
