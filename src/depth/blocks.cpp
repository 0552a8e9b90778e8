#include "depth/blocks.hpp"

#include <algorithm>
#include <cmath>

namespace palpate::depth {
namespace {

constexpr float kGate = 3;            // sigma
constexpr float kSteepest = 3;        // tangent of the incidence that a block may be seen at
constexpr float kHalfDiagonal = .7F;  // pixels from a block's middle to its pixels'

struct Gate {
  float nearest, farthest;  // m
  float s0, s1, s2;         // of kGate sigma and the steepest slope
};

Gate make_gate(const BlockGrid& grid, const NoiseModel& noise, const DepthFilterOptions& range) {
  const auto& s = noise.coefficients;
  const double pixel = std::max(std::abs(grid.step_x), std::abs(grid.step_y)) / 2;
  return {float(range.nearest), float(range.farthest), float(kGate * s[0]),
          float(kGate * s[1] + kSteepest * kHalfDiagonal * pixel), float(kGate * s[2])};
}

struct Mean {
  float depth;
  int count;
};

Mean gated_mean(std::array<float, 4> z, const Gate& gate) {
  int valid = 0;
  for (float& value : z) {
    const bool is = value >= gate.nearest && value <= gate.farthest;  // false for NaN
    value = is ? value : INFINITY;
    valid += is;
  }
  if (valid == 0) return {0, 0};
  std::sort(z.begin(), z.end());
  const float median = valid == 4   ? .5F * (z[1] + z[2])
                       : valid == 3 ? z[1]
                       : valid == 2 ? .5F * (z[0] + z[1])
                                    : z[0];
  const float width = gate.s0 + median * (gate.s1 + median * gate.s2);
  float sum = 0;
  int count = 0;
  for (const float value : z) {
    if (!(std::abs(value - median) <= width)) continue;
    sum += value;
    ++count;
  }
  return {count > 0 ? sum / float(count) : 0, count};
}

}  // namespace

void Blocks::resize(const BlockGrid& new_grid) {
  grid = new_grid;
  stride = static_cast<std::size_t>(grid.columns + 2 * kMargin + 7) / 8 * 8;
  const std::size_t size = stride * static_cast<std::size_t>(grid.rows + 2 * kMargin);
  rho.assign(size, 0.0F);
  counts.assign(size, 0);
}

void average_blocks(const float* image, int width, const NoiseModel& noise,
                    const DepthFilterOptions& range, Blocks& blocks) {
  const Gate gate = make_gate(blocks.grid, noise, range);
  for (int row = 0; row < blocks.grid.rows; ++row) {
    const float* upper = image + std::ptrdiff_t{2} * row * width;
    const float* lower = upper + width;
    const std::size_t begin = blocks.at(0, row);
    for (int column = 0; column < blocks.grid.columns; ++column) {
      const int u = 2 * column;
      const Mean mean = gated_mean({upper[u], upper[u + 1], lower[u], lower[u + 1]}, gate);
      const std::size_t to = begin + static_cast<std::size_t>(column);
      blocks.rho[to] = mean.count > 0 ? 1 / mean.depth : 0;
      blocks.counts[to] = static_cast<std::uint8_t>(mean.count);
    }
  }
}

}  // namespace palpate::depth
