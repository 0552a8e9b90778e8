#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/neighborhoods.hpp"
#include "geometry/parallel.hpp"

namespace palpate::detail {

/// The neighbourhood graph of a cloud: which points are near which. It is found once, and every
/// step that needs neighbours reads it: steps differ in what they do with a row, not in how they
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

  /// Finds all rows now and keeps them, while there are at most kMostKept neighbours. Others are
  /// found each time that they are read, as all are without this, and hold more than neighbours.
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
      const bool kept = !graph_.kept_.empty() && !graph_.kept_[block_].ends.empty();
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

  static constexpr std::size_t kBlocksAtOnce = 8;  // that a thread takes, at least (judgement)

  /// Finds the leaves from which find_row() picks the rows of a block.
  void find_leaves(const Block& block, Surroundings& surroundings) const;
  [[nodiscard]] NeighborRow find_row(const Block& part, Surroundings& surroundings) const;
  /// The same without points that are no neighbours: worth its time for rows that are kept.
  [[nodiscard]] NeighborRow find_sifted(const Block& part, Surroundings& surroundings) const;
  /// Finds the rows again that hold a point which is `wider`, or that `grown_cells` reach, m.
  void find_again(std::span<const std::uint8_t> wider, std::span<const float> grown_cells);

  const CellGrid* grid_ = nullptr;
  std::vector<float> radii_;             // m
  std::vector<float> squared_supports_;  // m^2; empty: none
  std::vector<float> cell_supports_;     // the largest in each cell, m; empty: none
  std::vector<Block> blocks_;
  std::vector<Kept> kept_;  // of each block; empty: keep() was not called
};

/// Pairs of neighbours, a row after another; keeps its memory in between.
class NearPairs {
 public:
  /// Calls visit(i, j) for each i of the row and each of its neighbours j within reach_of(i), m, of
  /// it, j in rising order; i itself is one.
  template <class ReachOf, class Visit>
  void each(const CellGrid& grid, const NeighborRow& row, const ReachOf& reach_of,
            const Visit& visit) {
    simd::Row squared = {};
    for (std::uint32_t q = 0; q < row.count; ++q) {
      const float reach = reach_of(row.first + q);
      squared[q] = reach * reach;
    }
    each_hit(grid, row, simd::best_joins().within, squared, visit);
  }

  /// The same where find(join, wanted, hits) returns what is near.
  template <class Find, class Wanted, class Visit>
  void each_hit(const CellGrid& grid, const NeighborRow& row, const Find& find,
                const Wanted& wanted, const Visit& visit) {
    const std::size_t candidates = row.neighbors.size() + 1;
    if (hits_.size() < candidates) hits_.resize(2 * candidates);
    const std::size_t found = find(row.join(grid), wanted, hits_.data());
    for (std::size_t h = 0; h < found; ++h) {
      for (std::uint32_t bits = hits_[h].queries; bits != 0; bits &= bits - 1) {
        visit(row.first + static_cast<std::uint32_t>(std::countr_zero(bits)), hits_[h].candidate);
      }
    }
  }

 private:
  std::vector<simd::Hit> hits_;
};

/// The points that are near each of a row's; keeps its memory in between.
class NearLists {
 public:
  /// Finds the neighbours within reach_of(i), m, of each point i of the row; none for 0.
  template <class ReachOf>
  void find(const CellGrid& grid, const NeighborRow& row, const ReachOf& reach_of) {
    for (auto& list : lists_) list.clear();
    pairs_.each(grid, row, reach_of,
                [&](std::uint32_t i, std::uint32_t j) { lists_[i - row.first].push_back(j); });
  }

  /// Neighbours of the point first + q, in rising order.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t q) const { return lists_[q]; }

 private:
  NearPairs pairs_;
  std::array<std::vector<std::uint32_t>, simd::kQueries> lists_;
};

/// Calls body(worker, i, near, around) for all points i whose reach is above 0, on every core when
/// there are many. `near`: the points within that reach, m, which the graph holds; `around`: all
/// neighbours in the point's row; both in rising order. `make_worker()`: memory of a block.
template <class MakeWorker, class Body>
void for_each_near(const NeighborhoodGraph& graph, std::span<const float> reaches,
                   const MakeWorker& make_worker, const Body& body) {
  graph.for_each_block<NearLists>([&](const auto& rows, NearLists& near) {
    auto worker = make_worker();
    rows.each([&](const NeighborRow& row) {
      const auto own = reaches.subspan(row.first, row.count);
      if (*std::max_element(own.begin(), own.end()) <= 0) return;
      near.find(graph.grid(), row, [&](std::uint32_t i) { return reaches[i]; });
      for (std::uint32_t q = 0; q < row.count; ++q) {
        if (own[q] > 0) body(worker, row.first + q, near.of(q), row.neighbors);
      }
    });
  });
}

}  // namespace palpate::detail
