#include "depth/window_fits.hpp"

#include <algorithm>
#include <cmath>

#include "depth/fill_gaps.hpp"
#include "geometry/parallel.hpp"

namespace palpate::depth {
namespace {

constexpr std::size_t kRowsAtATime = 8;

// How far windows beside a block may reach.
constexpr int kBorder = 2 * simd::kLargestWindow;

simd::BlockRows rows_of(const Blocks& blocks) {
  const std::size_t first = blocks.at(0, 0);
  return {blocks.rho.data() + first, blocks.counts.data() + first,
          static_cast<std::ptrdiff_t>(blocks.stride)};
}

}  // namespace

simd::FitInput WindowFits::input(const Blocks& blocks, const NoiseModel& noise, double normal_error,
                                 const BlockRange& range) {
  const BlockGrid& grid = blocks.grid;
  const auto& s = noise.coefficients;
  const double share = block_share(noise.correlation);
  return {.table = {.sums = table_.front().sums,
                    .first_column = range.first_column,
                    .first_row = range.first_row,
                    .columns = range.columns,
                    .rows = range.rows},
          .blocks = rows_of(blocks),
          .x0 = grid.x0,
          .y0 = grid.y0,
          .step_x = grid.step_x,
          .step_y = grid.step_y,
          .noise = {share * s[0], share * s[1], share * s[2]},
          .shared = shared_error(noise.correlation),
          .pixel_noise = {s[0], s[1], s[2]},
          .normal_error = normal_error,
          .growth = std::min(2.0, std::sqrt(noise.correlation))};
}

void WindowFits::list_columns(const Blocks& blocks, const FitRegion& region) {
  columns_.clear();
  row_begin_.clear();
  row_begin_.push_back(0);
  const BlockRange& range = region.range();
  for (int row = range.first_row; row < range.first_row + range.rows; ++row) {
    region.columns(blocks, row, columns_);
    row_begin_.push_back(columns_.size());
  }
}

void WindowFits::fit_row(const simd::FitInput& in, int row, std::span<const std::int32_t> columns,
                         BlockFits& fits) const {
  functions_->fit(in, row, columns.data(), static_cast<int>(columns.size()), fits.row(row));
  const std::size_t first = fits.grid.index(0, row);
  for (const std::int32_t column : columns) fits.states[first + column] = BlockState::fitted;
}

void WindowFits::fit(const Blocks& blocks, const NoiseModel& noise, double normal_error,
                     const FitRegion& region, BlockFits& fits) {
  const BlockGrid& grid = blocks.grid;
  if (filled_.grid != grid) {
    table_.resize(static_cast<std::size_t>(grid.columns + 1) * (grid.rows + 1));
    columns_.reserve(grid.size());
    row_begin_.reserve(static_cast<std::size_t>(grid.rows) + 1);
  }
  if (region.range().empty()) return;
  const BlockRange range = region.range().grown(kBorder, grid);
  fill_gaps(blocks, noise, range, filled_);
  const simd::FitInput in = input(blocks, noise, normal_error, range);
  functions_->table(in.table, rows_of(filled_));
  list_columns(blocks, region);
  const auto count = static_cast<std::size_t>(region.range().rows);
  detail::parallel_ranges(count, kRowsAtATime, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      fit_row(in, region.range().first_row + static_cast<int>(r),
              std::span(columns_).subspan(row_begin_[r], row_begin_[r + 1] - row_begin_[r]), fits);
    }
  });
  faces_.refit(in, filled_, noise, fits);
}

}  // namespace palpate::depth
