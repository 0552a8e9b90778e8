#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/neighborhoods.hpp"
#include "geometry/parallel.hpp"

namespace palpate::detail {

/// The neighbourhood graph of a cloud: which points are near which. It is found once R is chosen,
/// and most steps from there on read it: they differ in what they do with a row, not in how they
/// search.
///
/// A row belongs to a few points that stand together, since these have most of their neighbours in
/// common and sums over a row are made for all of them at once. A step asks for no more than the
/// graph holds, and tests the distances that it wants; widen() what is to hold more. Rows depend on
/// the points and on what was asked for, never on the number of threads.
///
/// Refers to the grid, which has to stay where it is.
class NeighborhoodGraph {
 public:
  NeighborhoodGraph() = default;  ///< of no point

  /// Neighbours of a point are all within its own `radii`, and those within whose `supports`
  /// (empty: 0) it lies. One of each for every point, in sorted order, m.
  explicit NeighborhoodGraph(const CellGrid& grid, std::vector<float> radii,
                             std::span<const float> supports = {});

  /// Finds all rows now and keeps them, but for blocks of more than kMostAPoint neighbours a point:
  /// theirs are found each time that they are read. Without this all are, and hold more than
  /// neighbours.
  void keep();

  /// Lets the graph hold what is within these `radii` and `supports`, too.
  void widen(std::span<const float> radii, std::span<const float> supports);

  [[nodiscard]] const CellGrid& grid() const { return *grid_; }

  /// The rows of one block of the index: up to kBlockPoints points.
  class BlockRows {
   public:
    BlockRows(const NeighborhoodGraph& graph, std::size_t block, Surroundings& surroundings)
        : graph_(graph), block_(block), surroundings_(surroundings) {}

    [[nodiscard]] std::size_t number() const { return block_; }
    [[nodiscard]] const Block& block() const { return graph_.blocks_[block_]; }

    /// Calls visit(row) for each of the block's, in rising order.
    template <class Visit>
    void each(const Visit& visit) const {
      const bool kept = graph_.is_kept(block_);
      if (!kept) graph_.find_leaves(block(), surroundings_);
      std::size_t k = 0;
      for_each_part(block(), [&](const Block& part) {
        if (kept) {
          visit(NeighborRow{part.begin, part.size(), graph_.kept_[block_].row(k++)});
        } else {
          visit(graph_.find_row(make_block(graph_.grid(), part.begin, part.end), surroundings_));
        }
      });
    }

   private:
    const NeighborhoodGraph& graph_;
    std::size_t block_;
    Surroundings& surroundings_;
  };

  /// How many blocks there are.
  [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }

  /// Calls body(rows, memory) for the BlockRows of each block, on every core when there are many.
  /// A `Memory` keeps its room from one block to the next.
  template <class Memory, class Body>
  void for_each_block(const Body& body) const {
    struct Both {
      Surroundings surroundings;
      Memory memory;
    };
    parallel_each_with<Both>(blocks_.size(), kBlocksAtOnce, [&](std::size_t b, Both& both) {
      body(BlockRows(*this, b, both.surroundings), both.memory);
    });
  }

  /// Calls body(row) for all rows, likewise.
  template <class Body>
  void for_each_row(const Body& body) const {
    struct Nothing {};
    for_each_block<Nothing>([&](const BlockRows& rows, Nothing&) { rows.each(body); });
  }

  /// Calls body(i, neighbors of its row, memory) for all points, likewise.
  template <class Memory, class Body>
  void for_each_point(const Body& body) const {
    for_each_block<Memory>([&](const BlockRows& rows, Memory& memory) {
      rows.each([&](const NeighborRow& row) {
        for (std::uint32_t q = 0; q < row.count; ++q) body(row.first + q, row.neighbors, memory);
      });
    });
  }

 private:
  struct Kept {
    std::vector<std::uint32_t> neighbors;
    std::vector<std::uint32_t> ends;  // of the rows, in `neighbors`; empty: none is kept

    void clear() {
      neighbors.clear();
      ends.clear();
    }
    void push_back(std::span<const std::uint32_t> row) {
      neighbors.insert(neighbors.end(), row.begin(), row.end());
      ends.push_back(static_cast<std::uint32_t>(neighbors.size()));
    }
    [[nodiscard]] std::span<const std::uint32_t> row(std::size_t k) const {
      const std::uint32_t begin = k == 0 ? 0 : ends[k - 1];
      return std::span(neighbors).subspan(begin, ends[k] - begin);
    }
  };

  struct Search {
    Surroundings around;
    Kept rows;
  };

  // Neighbours in the rows of a block, at most: half a kilobyte a point. R of 4 spacings has 19
  // (measured), so this is R of 10.
  static constexpr std::size_t kMostAPoint = 128;
  static constexpr std::size_t kBlocksAtOnce = 8;  // that a thread takes, at least (judgement)

  [[nodiscard]] bool is_kept(std::size_t block) const {
    return !kept_.empty() && !kept_[block].ends.empty();
  }

  /// Finds the leaves from which find_row() picks the rows of a block.
  void find_leaves(const Block& block, Surroundings& surroundings) const;
  [[nodiscard]] NeighborRow find_row(const Block& part, Surroundings& surroundings) const;
  void keep_block(std::size_t b, Search& search);

  const CellGrid* grid_ = nullptr;
  std::vector<float> radii_;             // m
  std::vector<float> squared_supports_;  // m^2; empty: none
  std::vector<float> cell_supports_;     // the largest in each cell, m; empty: none
  std::vector<Block> blocks_;
  std::vector<Kept> kept_;  // of each block; empty: keep() was not called
};

}  // namespace palpate::detail
