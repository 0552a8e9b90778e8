#include "scene/policies/block_entries.hpp"

#include <algorithm>
#include <cstddef>
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

BlockOrder make_block_order(int columns, int rows) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;  // code, block
  places.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      const std::uint32_t code =
          spread(static_cast<std::uint32_t>(v)) << 1 | spread(static_cast<std::uint32_t>(u));
      places.emplace_back(code, static_cast<std::uint32_t>(v * columns + u));
    }
  }
  std::sort(places.begin(), places.end());
  BlockOrder order{.columns = columns, .rows = rows, .blocks = {}, .codes = {}};
  for (const auto& [code, block] : places) {
    order.blocks.push_back(block);
    order.codes.push_back(code);
  }
  return order;
}

void BlockEntries::sort(std::span<const Entry> entries, std::size_t blocks) {
  begin_.resize(blocks + 2);
  std::fill(begin_.begin(), begin_.end(), 0u);
  for (const Entry& entry : entries) ++begin_[entry.place + 2];
  for (std::size_t place = 2; place < begin_.size(); ++place) begin_[place] += begin_[place - 1];
  sorted_.resize(entries.size());
  // begin_[place + 1] runs from where the place's entries begin to where they end.
  for (std::size_t i = 0; i < entries.size(); ++i) {
    sorted_[begin_[entries[i].place + 1]++] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace palpate
