// Averages pixels into 2 x 2 blocks, rejects flying pixels, and fills gaps within one surface.
#include "depth/blocks.hpp"

#include <algorithm>
#include <cmath>

#include "depth/simd/fits.hpp"

namespace palpate::depth {
namespace {

// Pixels from a block's middle to its pixels' middles: sqrt(2) / 2 (derived)
constexpr float kHalfDiagonal = .7F;
// Tangent of an incidence of 70 degrees, up to which neighbours count as close (judgement)
constexpr double kSteepest = 2.75;
constexpr int kSupporters = 2;  // of eight neighbours; fewer: a flying pixel (docs/method.md 6.3)
constexpr float kStraight = 7.3F;  // 3 sigma of a - 2 b + c: 3 sqrt(6) (derived)

simd::BlockLimits limits_of(const NoiseModel& noise, const BlockGrid& grid) {
  const auto& s = noise.coefficients;
  const double share = block_share(noise.correlation);
  return {{static_cast<float>(share * s[0]), static_cast<float>(share * s[1]),
           static_cast<float>(share * s[2])},
          SameSurface::kClose,
          SameSurface(noise, grid).steep,
          kStraight};
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
  const simd::DepthGate gate = depth_gate(blocks.grid, kHalfDiagonal, noise, range);
  for_rows(blocks.grid, [&](int row) {
    const std::size_t to = blocks.at(0, row);
    simd::best_plain().average(image + std::ptrdiff_t{2} * row * width, width, blocks.grid.columns,
                               gate, blocks.rho.data() + to, blocks.counts.data() + to);
  });
}

SameSurface::SameSurface(const NoiseModel& noise_model, const BlockGrid& grid)
    : noise(noise_model),
      steep(
          static_cast<float>(kSteepest * std::max(std::abs(grid.step_x), std::abs(grid.step_y)))) {}

void reject_flying(const NoiseModel& noise, Blocks& blocks) {
  const simd::BlockLimits limits = limits_of(noise, blocks.grid);
  const auto stride = static_cast<std::ptrdiff_t>(blocks.stride);
  blocks.measured = blocks.rho;
  for_rows(blocks.grid, [&](int row) {
    const std::size_t at = blocks.at(0, row);
    simd::best_plain().reject(blocks.measured.data() + at, stride, blocks.grid.columns, limits,
                              kSupporters, blocks.rho.data() + at, blocks.counts.data() + at);
  });
}

void fit_plain(const Blocks& blocks, const NoiseModel& noise, int row, int first, int count,
               BlockFits& fits) {
  const simd::BlockLimits limits = limits_of(noise, blocks.grid);
  const auto stride = static_cast<std::ptrdiff_t>(blocks.stride);
  const auto per_x = static_cast<float>(1 / blocks.grid.step_x);
  const auto per_y = static_cast<float>(1 / blocks.grid.step_y);
  const std::size_t from = blocks.at(first, row);
  simd::best_plain().fit(blocks.rho.data() + from, blocks.counts.data() + from, stride, count,
                         limits, per_x, per_y, fits.row(row, first));
}

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
  for_rows(range, [&](int row) {
    const auto at = static_cast<std::ptrdiff_t>(blocks.at(range.first_column, row));
    std::copy_n(blocks.rho.begin() + at, range.columns, filled.rho.begin() + at);
    std::copy_n(blocks.counts.begin() + at, range.columns, filled.counts.begin() + at);
    bridge_line(same, filled.rho.data() + at, 1, range.columns);
  });
  float* top = filled.rho.data() + blocks.at(range.first_column, range.first_row);
  detail::parallel_each(static_cast<std::size_t>(range.columns), kLinesAtATime,
                        [&](std::size_t c) { bridge_line(same, top + c, stride, range.rows); });
}

}  // namespace palpate::depth
