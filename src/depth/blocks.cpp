#include "depth/blocks.hpp"

#include <algorithm>
#include <cmath>

#include "depth/simd/plain.hpp"

namespace palpate::depth {
namespace {

constexpr float kGate = 3;            // sigma
constexpr float kSteepest = 3;        // tangent of the incidence that a block may be seen at
constexpr float kHalfDiagonal = .7F;  // pixels from a block's middle to its pixels'

simd::BlockGate make_gate(const BlockGrid& grid, const NoiseModel& noise,
                          const DepthFilterOptions& range) {
  const auto& s = noise.coefficients;
  const double pixel = std::max(std::abs(grid.step_x), std::abs(grid.step_y)) / 2;
  return {static_cast<float>(range.nearest),
          static_cast<float>(range.farthest),
          {static_cast<float>(kGate * s[0]),
           static_cast<float>(kGate * s[1] + kSteepest * kHalfDiagonal * pixel),
           static_cast<float>(kGate * s[2])}};
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
  const simd::BlockGate gate = make_gate(blocks.grid, noise, range);
  for (int row = 0; row < blocks.grid.rows; ++row) {
    const std::size_t to = blocks.at(0, row);
    simd::best_plain().average(image + std::ptrdiff_t{2} * row * width, width, blocks.grid.columns,
                               gate, blocks.rho.data() + to, blocks.counts.data() + to);
  }
}

}  // namespace palpate::depth
