#include "depth/blocks.hpp"

#include "depth/simd/plain.hpp"

namespace palpate::depth {
namespace {

constexpr float kHalfDiagonal = .7F;  // pixels from a block's middle to its pixels'

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
  const simd::DepthGate gate = depth_gate(blocks.grid, kHalfDiagonal, noise, range);
  for_rows(blocks.grid, [&](int row) {
    const std::size_t to = blocks.at(0, row);
    simd::best_plain().average(image + std::ptrdiff_t{2} * row * width, width, blocks.grid.columns,
                               gate, blocks.rho.data() + to, blocks.counts.data() + to);
  });
}

}  // namespace palpate::depth
