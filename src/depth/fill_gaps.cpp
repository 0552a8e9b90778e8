#include "depth/fill_gaps.hpp"

#include <algorithm>
#include <cmath>

#include "depth/neighbors.hpp"

namespace palpate::depth {
namespace {

// Bridges from block `begin` to `end`, `step` apart from one to the next.
void bridge(const SameSurface& same, float* rho, std::ptrdiff_t begin, std::ptrdiff_t end,
            std::ptrdiff_t step) {
  const auto length = static_cast<float>((end - begin) / step);
  const float rise = rho[end] - rho[begin];
  if (std::abs(rise) > same.limit(rho[begin], length)) return;
  for (std::ptrdiff_t i = begin + step; i != end; i += step) {
    rho[i] = rho[begin] + rise * static_cast<float>((i - begin) / step) / length;
  }
}

// In one row or column of `count` blocks.
void bridge_line(const SameSurface& same, float* rho, std::ptrdiff_t step, int count) {
  int last = -1;
  for (int i = 0; i < count; ++i) {
    if (!(rho[i * step] > 0)) continue;
    const int gap = i - last - 1;
    if (last >= 0 && gap > 0 && gap <= kLongestGap) bridge(same, rho, last * step, i * step, step);
    last = i;
  }
}

}  // namespace

void fill_gaps(const Blocks& blocks, const NoiseModel& noise, const BlockRange& range,
               Blocks& filled) {
  if (filled.grid != blocks.grid) filled.resize(blocks.grid);
  const SameSurface same(noise, blocks.grid);
  const auto stride = static_cast<std::ptrdiff_t>(blocks.stride);
  for (int row = range.first_row; row < range.first_row + range.rows; ++row) {
    const auto at = static_cast<std::ptrdiff_t>(blocks.at(range.first_column, row));
    std::copy_n(blocks.rho.begin() + at, range.columns, filled.rho.begin() + at);
    std::copy_n(blocks.counts.begin() + at, range.columns, filled.counts.begin() + at);
    bridge_line(same, filled.rho.data() + at, 1, range.columns);
  }
  float* top = filled.rho.data() + blocks.at(range.first_column, range.first_row);
  for (int column = 0; column < range.columns; ++column) {
    bridge_line(same, top + column, stride, range.rows);
  }
}

}  // namespace palpate::depth
