// Finds the tiles of a depth image in which nothing has changed.
#include "depth/still_tiles.hpp"

#include <algorithm>

namespace palpate::depth {
namespace {

constexpr int kSide = KeptTiles::kSide;  // blocks

// Squared deviations that noise does not reach by chance.
constexpr float kBlock = 25;  // of a block's difference (judgement)
constexpr float kMean = 9;    // of the mean difference of tiles (judgement)

// Frames in which each tile is filtered once, though it stands still: half a second at 30 Hz
// (judgement).
constexpr unsigned kInTurn = 16;

}  // namespace

void StillTiles::forget(const BlockGrid& grid) {
  grid_ = grid;
  tiles_ = (grid.columns + kSide - 1) / kSide;
  frame_ = 0;
  rho_.resize(grid.size());
  settled_.assign(static_cast<std::size_t>(tiles_) * grid.rows, 0);
}

bool StillTiles::are_settled(int column, int row) {
  for (int r = row; r < std::min(row + kSide, grid_.rows); ++r) {
    if (settled(column, r) == 0) return false;
  }
  return true;
}

/// Holes stay holes, and each block stays where it was, or the tile does not stand still.
StillTiles::Change StillTiles::change_of(const Blocks& blocks, const NoiseModel& noise, int column,
                                         int row) const {
  const int count = std::min(kSide, grid_.columns - column);
  Change change;
  for (int r = row; r < std::min(row + kSide, grid_.rows); ++r) {
    const float* const now = &blocks.rho[blocks.at(column, r)];
    const float* const before = &rho_[grid_.index(column, r)];
    bool near = true;
    for (int k = 0; k < count; ++k) {
      const float sigma = before[k] > 0 ? block_sigma(noise, before[k]) : 0;
      const float both = 2 * sigma * sigma;
      const float off = now[k] - before[k];
      near = near & ((now[k] > 0) == (before[k] > 0)) & (off * off <= kBlock * both);
      change.sum += off;
      change.variance += both;
    }
    if (!near) return {};
  }
  change.still = true;
  return change;
}

/// Is a tile where it was, and so are the tiles around it together, which show smaller changes?
/// `shared`: by how much a tile's mean varies more than if its blocks erred alone. The tiles around
/// it are not granted that: some are filtered for nothing, but what creeps is followed.
bool StillTiles::stays(int tile, int row, float shared) const {
  const auto at = [&](int t, int r) { return changes_[static_cast<std::size_t>(r) * tiles_ + t]; };
  const Change own = at(tile, row);
  if (!own.still || own.sum * own.sum > kMean * shared * own.variance) return false;
  const int last = static_cast<int>(changes_.size()) / tiles_ - 1;
  Change around;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, last); ++r) {
    for (int t = std::max(tile - 1, 0); t <= std::min(tile + 1, tiles_ - 1); ++t) {
      around.sum += at(t, r).sum;
      around.variance += at(t, r).variance;
    }
  }
  return around.sum * around.sum <= kMean * around.variance;
}

void StillTiles::find(const Blocks& blocks, const NoiseModel& noise, const BlockRange& change,
                      bool averaged, KeptTiles& kept) {
  const unsigned frames = averaged ? kInTurn : 1;
  ++frame_;
  kept.columns = grid_.columns;
  kept.flags.resize(kept.index(0, grid_.rows + kSide - 1));
  changes_.resize(kept.flags.size());
  const std::size_t rows = changes_.size() / tiles_;
  detail::parallel_each(rows, 1, [&](std::size_t v) {
    const int row = static_cast<int>(v) * kSide;
    for (int column = 0; column < grid_.columns; column += kSide) {
      const bool may = !change.overlaps({column, row, kSide, kSide}) && are_settled(column, row);
      changes_[kept.index(column, row)] = may ? change_of(blocks, noise, column, row) : Change();
    }
  });
  const auto shared = static_cast<float>(shared_error(noise.correlation));
  detail::parallel_each(rows, 1, [&](std::size_t v) {
    const bool turn = (v + frame_) % frames == 0;
    for (int tile = 0; tile < tiles_; ++tile) {
      const bool still = !turn && stays(tile, static_cast<int>(v), shared);
      kept.flags[v * tiles_ + tile] = still ? 1 : 0;
    }
  });
}

void StillTiles::remember(const Blocks& blocks, int row, int first, int count,
                          const std::uint8_t* settled_blocks) {
  std::copy_n(&blocks.rho[blocks.at(first, row)], count, &rho_[grid_.index(first, row)]);
  for (int k = 0; k < count; k += kSide) {
    const std::uint8_t* const end = settled_blocks + std::min(k + kSide, count);
    settled(first + k, row) = std::find(settled_blocks + k, end, 0) == end ? 1 : 0;
  }
}

}  // namespace palpate::depth
