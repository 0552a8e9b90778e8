// Counts points in cells, and joins cells to chunks.
#include "io/tile/cell_counter.hpp"

#include <algorithm>

namespace palpate::io::tile {
namespace {

constexpr int kLevels = 8;                  // of the first grid: 64 MiB (judgement)
constexpr int kInnerLevels = 6;             // of those inside: 1 MiB (judgement)
constexpr std::uint32_t kGrid = 1U << 31U;  // marks the number of a grid

std::size_t place_in(const Cell& grid, int levels, const Cell& cell) {
  Numbers inside = cell.at;
  for (std::size_t k = 0; k < 3; ++k) inside[k] -= grid.at[k] << levels;
  return morton(inside);
}

}  // namespace

CellCounter::CellCounter(int bits) : bits_(bits) {
  add_grid({}, kLevels);
}

void CellCounter::add_grid(const Cell& cell, int levels) {
  Grid grid{cell, std::min(levels, bits_ - cell.level), {}};
  grid.counts.resize(std::size_t{1} << (3 * grid.levels));
  grids_.push_back(std::move(grid));
}

void CellCounter::add(const Numbers& numbers) {
  std::size_t number = 0;
  while (true) {
    Grid& grid = grids_[number];
    const Cell cell = cell_of(numbers, grid.cell.level + grid.levels, bits_);
    std::uint32_t& count = grid.counts[place_in(grid.cell, grid.levels, cell)];
    if ((count & kGrid) == 0) {
      if (number >= fresh_) ++count;
      return;
    }
    number = count & ~kGrid;
  }
}

bool CellCounter::refine(std::size_t most) {
  const std::size_t before = grids_.size();
  for (std::size_t number = fresh_; number < before; ++number) {
    const int level = grids_[number].cell.level + grids_[number].levels;
    if (level >= bits_) continue;
    for (std::size_t i = 0; i < grids_[number].counts.size(); ++i) {
      if (grids_[number].counts[i] <= most) continue;
      Cell cell = grids_[number].cell;
      for (int bit = grids_[number].levels - 1; bit >= 0; --bit) {
        cell = cell.child(i >> (3 * bit) & 7U);
      }
      grids_[number].counts[i] = kGrid | static_cast<std::uint32_t>(grids_.size());
      add_grid(cell, kInnerLevels);
    }
  }
  fresh_ = before;
  return grids_.size() > before;
}

std::size_t CellCounter::total(std::size_t grid, std::size_t first, std::size_t count) const {
  std::size_t sum = 0;
  const std::vector<std::uint32_t>& counts = grids_[grid].counts;
  for (std::size_t i = first; i < first + count; ++i) {
    const std::uint32_t inside = counts[i] & ~kGrid;
    sum += (counts[i] & kGrid) == 0 ? inside : total(inside, 0, grids_[inside].counts.size());
  }
  return sum;
}

std::vector<Chunk> CellCounter::chunks(std::size_t most) const {
  std::vector<Chunk> chunks;
  collect(0, {}, most, chunks);
  return chunks;
}

void CellCounter::collect(std::size_t grid, const Cell& cell, std::size_t most,
                          std::vector<Chunk>& chunks) const {
  const Grid& here = grids_[grid];
  const int below = here.levels - (cell.level - here.cell.level);
  Cell first = cell;
  for (int i = 0; i < below; ++i) first = first.child(0);
  const std::size_t place = place_in(here.cell, here.levels, first);
  const std::size_t points = total(grid, place, std::size_t{1} << (3 * below));
  if (points == 0) return;
  const std::uint32_t single = here.counts[place];
  if (points <= most || (below == 0 && (single & kGrid) == 0)) {
    chunks.push_back({cell, points});
  } else if (below == 0) {
    collect(single & ~kGrid, cell, most, chunks);
  } else {
    for (unsigned i = 0; i < 8; ++i) collect(grid, cell.child(i), most, chunks);
  }
}

}  // namespace palpate::io::tile
