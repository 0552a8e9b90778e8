// Declares how points are counted in cells, and cells are joined to chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "io/tile/frame.hpp"

namespace palpate::io::tile {

/// The most points that a CellCounter counts.
inline constexpr std::size_t kMostCounted = std::numeric_limits<std::int32_t>::max();

/// A cube whose points fit into memory together.
struct Chunk {
  Cell cell;
  std::size_t points = 0;
};

/// Counts points in the cells of a grid; where one holds too many, in cells of a grid inside it
/// when the points are counted once more. So strays far from a cloud do no harm.
class CellCounter {
 public:
  /// `bits`: of the numbers that are counted.
  explicit CellCounter(int bits);

  /// Up to kMostCounted points in all.
  void add(const Numbers& numbers);

  /// Lays grids into cells of more than `most` points. True: there are such; all points have to be
  /// added again.
  [[nodiscard]] bool refine(std::size_t most);

  /// The largest cubes of at most `most` points along the Morton curve; more are only in a cube
  /// that cannot be split.
  [[nodiscard]] std::vector<Chunk> chunks(std::size_t most) const;

 private:
  struct Grid {
    Cell cell;
    int levels = 0;                     // 2^levels cells a side
    std::vector<std::uint32_t> counts;  // along the Morton curve; or which grid is inside
  };
  void add_grid(const Cell& cell, int levels);
  void collect(std::size_t grid, const Cell& cell, std::size_t most,
               std::vector<Chunk>& chunks) const;
  [[nodiscard]] std::size_t total(std::size_t grid, std::size_t first, std::size_t count) const;

  int bits_;
  std::vector<Grid> grids_;
  std::size_t fresh_ = 0;  // the first grid in which points are counted now
};

}  // namespace palpate::io::tile
