#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "depth/blocks.hpp"

namespace palpate::depth {

/// Finds the tiles in which a still camera sees, within noise, what it saw when they were filtered
/// last. Where all blocks average as many frames as they ever do, one more would add next to
/// nothing.
class StillTiles {
 public:
  /// Nothing stands still until it has been filtered again.
  void forget(const BlockGrid& grid);

  /// Blocks in `change` do not stand still. Each tile is filtered once in 16 frames all the same,
  /// so that what moves within noise is followed; always where frames are not `averaged`.
  void find(const Blocks& blocks, const NoiseModel& noise, const BlockRange& change, bool averaged,
            KeptTiles& kept);

  /// Remembers what some blocks of a row, a whole number of tiles, were filtered from.
  /// `settled_blocks`: of each, does it average as many frames as it ever will?
  void remember(const Blocks& blocks, int row, int first, int count,
                const std::uint8_t* settled_blocks);

 private:
  [[nodiscard]] std::uint8_t& settled(int column, int row) {
    return settled_[static_cast<std::size_t>(row) * tiles_ + column / KeptTiles::kSide];
  }
  /// How far the blocks of a tile are from where they were.
  struct Change {
    float sum = 0;       ///< 1/m
    float variance = 0;  ///< that noise gives the sum, 1/m^2
    bool still = false;  ///< is no block elsewhere?
  };

  [[nodiscard]] bool are_settled(int column, int row);
  [[nodiscard]] Change change_of(const Blocks& blocks, const NoiseModel& noise, int column,
                                 int row) const;
  [[nodiscard]] bool stays(int tile, int row, float shared) const;

  BlockGrid grid_;
  int tiles_ = 0;                      // in a row
  unsigned frame_ = 0;                 // of those since all was forgotten
  std::vector<std::uint8_t> settled_;  // of a tile's blocks in each row: are all?
  std::vector<float> rho_;             // of blocks when they were filtered last, 1/m
  std::vector<Change> changes_;        // of tiles, row by row
};

}  // namespace palpate::depth
