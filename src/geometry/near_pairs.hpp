// What is near the points of a row, by their own reaches.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/neighborhood_graph.hpp"

namespace palpate::detail {

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
