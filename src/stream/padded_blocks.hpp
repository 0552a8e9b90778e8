// Declares columns of blocks side by side, for sums over neighbours.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/parallel.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/field/field_options.hpp"

namespace palpate {

/// Calls visit(row) for the rows of a frame, on several threads.
template <class Visit>
void each_row(const FilteredDepth& depth, const Visit& visit) {
  constexpr std::size_t kRowsAtATime = 8;  // judgement: shares work among threads
  detail::parallel_each(static_cast<std::size_t>(depth.rows), kRowsAtATime,
                        [&](std::size_t v) { visit(v); });
}

/// Calls take(row, first, count) for the blocks of a frame that are not kept, or for all of them,
/// on several threads.
template <class Take>
void each_other(const FilteredDepth& depth, bool whole, const Take& take) {
  each_row(depth, [&](std::size_t v) {
    const int row = static_cast<int>(v);
    if (whole || depth.kept.flags.empty()) return take(row, 0, depth.columns);
    depth.kept.each_other(row, [&](int first, int count) { take(row, first, count); });
  });
}

/// Columns of blocks with a margin of nothing all around, so that all blocks have neighbours.
struct PaddedBlocks {
  int margin = 0;  ///< blocks
  std::size_t stride = 0;
  std::vector<float> x, y, z;     ///< m
  std::vector<float> reaches;     ///< in depth, of what may be the same surface, m
  std::vector<float> per_r2;      ///< 1 / R^2, 1/m^2
  std::vector<float> precisions;  ///< 1/m^2; 0: no point
  std::vector<float> sums;        ///< S_i
  std::vector<float> ones;

  static constexpr float kNowhere = 1e30f;  ///< 1 / R^2 of no point, 1/m^2

  /// Where a block stands in the columns.
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v + margin) * stride + static_cast<std::size_t>(u + margin);
  }

  /// Makes room for the columns of a frame, with a margin of so many blocks.
  /// @return has all that was there been forgotten?
  bool make_room(const FilteredDepth& depth, int blocks);

  /// Copies the positions of some blocks of a row into the columns.
  void lay_out_positions(const FilteredDepth& depth, int v, int first, int count);
};

}  // namespace palpate
