#pragma once

#include <span>
#include <vector>

#include "depth/block_fits.hpp"
#include "depth/blocks.hpp"

namespace palpate::depth {

/// Gives blocks near creases and convex edges to one of the planes that meet there.
///
/// The window that serves a block best may show a plane that another surface hides there: a table
/// continued behind a wall, which correlated noise takes for the wall's lowest rows. So where the
/// planes of two blocks on either side explain what was measured around a block, and surely better
/// than its own plane does, it gets one of theirs: of two that meet concavely the nearer one along
/// its ray, of two that meet convexly the farther one. Up to six blocks from the rim of what is
/// fitted, such planes may be missing.
class MeetingPlanes {
 public:
  /// Changes the fits of the listed blocks: `columns[row_begin[r]]` on are those of row
  /// `first_row + r`.
  void assign(const Blocks& blocks, const NoiseModel& noise, int first_row,
              const std::vector<std::int32_t>& columns, const std::vector<std::size_t>& row_begin,
              BlockFits& fits);

 private:
  /// What a block's fit becomes.
  struct Change {
    std::size_t block;
    float rho, variance, slope_x, slope_y, slope_variance;
  };

  /// Writes what changes in a row from `changes` on; returns how many do.
  static std::size_t search_row(const Blocks& blocks, const NoiseModel& noise, int row,
                                std::span<const std::int32_t> columns, const BlockFits& fits,
                                Change* changes);

  std::vector<Change> changes_;  // those of a row stand where its columns do
  std::vector<std::size_t> counts_;
};

}  // namespace palpate::depth
