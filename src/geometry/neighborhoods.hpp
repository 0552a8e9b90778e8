#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geometry/parallel.hpp"
#include "geometry/simd/joins.hpp"
#include "palpate/geometry/cell_grid.hpp"

namespace palpate::detail {

/// Squared distances between points and from a point or box to a cell's box, in float, added in one
/// fixed order: float rounding is monotone, so a box is never farther than a point within it.
[[nodiscard]] inline float squared_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const float x = a.x() - b.x();
  const float y = a.y() - b.y();
  const float z = a.z() - b.z();
  return x * x + y * y + z * z;
}

/// Three numbers in one register: compilers turn a scalar maximum into a branch, and whether boxes
/// overlap cannot be foretold.
struct Lanes {
  typedef float Floats __attribute__((vector_size(16)));

  Floats v;

  explicit Lanes(const Floats& floats) : v(floats) {}
  /// Three of four numbers.
  explicit Lanes(const float* floats) {
    std::memcpy(&v, floats, sizeof v);
    v[3] = 0;
  }
  explicit Lanes(const Eigen::Vector3f& p) : v{p.x(), p.y(), p.z(), 0.f} {}

  [[nodiscard]] Lanes operator-(const Lanes& other) const { return Lanes(v - other.v); }
  [[nodiscard]] Lanes larger(const Lanes& other) const { return Lanes(v < other.v ? other.v : v); }
  [[nodiscard]] float squared_norm() const {
    const Floats squares = v * v;
    return squares[0] + squares[1] + squares[2];
  }
};

/// The cell's box, each bound read together with the number that stands behind it.
[[nodiscard]] inline std::pair<Lanes, Lanes> box_of(const CellGrid::Cell& cell) {
  static_assert(offsetof(CellGrid::Cell, upper) == 3 * sizeof(float));
  return {Lanes(cell.lower.data()), Lanes(cell.upper.data())};
}

/// Between the boxes [lower, upper] and the cell's.
[[nodiscard]] inline float squared_distance(const CellGrid::Cell& cell,
                                            const Eigen::Vector3f& lower,
                                            const Eigen::Vector3f& upper) {
  const auto [cell_lower, cell_upper] = box_of(cell);
  const Lanes below = cell_lower - Lanes(upper);
  const Lanes above = Lanes(lower) - cell_upper;
  return below.larger(above).larger(Lanes(Lanes::Floats{})).squared_norm();
}

[[nodiscard]] inline float squared_distance(const CellGrid::Cell& cell,
                                            const Eigen::Vector3f& point) {
  return squared_distance(cell, point, point);
}

/// From the point to the farthest corner of the cell's box: no point of the cell is farther.
[[nodiscard]] inline float largest_squared_distance(const CellGrid::Cell& cell,
                                                    const Eigen::Vector3f& point) {
  const auto [lower, upper] = box_of(cell);
  return (upper - Lanes(point)).larger(Lanes(point) - lower).squared_norm();
}

/// Points [begin, end) of the sorted order and their tight box, m.
struct Block {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  Eigen::Vector3f lower = Eigen::Vector3f::Zero();
  Eigen::Vector3f upper = Eigen::Vector3f::Zero();

  [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

/// The block of these points.
[[nodiscard]] Block make_block(const CellGrid& grid, std::uint32_t begin, std::uint32_t end);

/// All points once, in sorted order: the largest cells with at most `most` points, and pieces of
/// leaves that hold more.
[[nodiscard]] std::vector<Block> make_blocks(const CellGrid& grid, std::uint32_t most);

/// The points [first, first + count) and what may be near them.
[[nodiscard]] inline simd::Join make_join(const CellGrid& grid, std::uint32_t first,
                                          std::uint32_t count, std::span<const simd::Run> runs) {
  return {grid.points().front().data(), first, count, runs.data(), runs.size()};
}

/// Search radii. Each is in metres, sorted, and may be empty for 0.
struct Reach {
  std::span<const float> of_points;  ///< a point visits all candidates within its own radius ...
  float times = 1;                   ///< ... times this
  std::span<const float>
      of_cells;  ///< largest radius within which the points of a cell are visited
};

/// For each cell the one of its points' values that pick(a, b) leaves of any two.
template <class Pick>
[[nodiscard]] std::vector<float> pick_in_cells(const CellGrid& grid, std::span<const float> values,
                                               const Pick& pick) {
  const std::span<const CellGrid::Cell> cells = grid.cells();
  std::vector<float> picked(cells.size());
  const auto pick_of = [&](std::span<const float> some) {
    return std::accumulate(some.begin() + 1, some.end(), some.front(), pick);
  };
  parallel_each(cells.size(), std::size_t{1} << 14, [&](std::size_t c) {
    const CellGrid::Cell& cell = cells[c];
    if (cell.children == 0) picked[c] = pick_of(values.subspan(cell.begin, cell.size()));
  });
  for (std::size_t c = cells.size(); c-- > 0;) {  // children stand behind their parents
    const CellGrid::Cell& cell = cells[c];
    if (cell.children == 0) continue;
    picked[c] = pick_of(std::span<const float>(picked).subspan(cell.first_child, cell.children));
  }
  return picked;
}

[[nodiscard]] inline std::vector<float> largest_in_cells(const CellGrid& grid,
                                                         std::span<const float> values) {
  return pick_in_cells(grid, values, [](float a, float b) { return a < b ? b : a; });
}

[[nodiscard]] inline std::vector<float> smallest_in_cells(const CellGrid& grid,
                                                          std::span<const float> values) {
  return pick_in_cells(grid, values, [](float a, float b) { return b < a ? b : a; });
}

/// The leaves around a block, found once, and which of their points may be near a part of it.
class Surroundings {
 public:
  /// Finds the leaves within `radius` of the block, or within the cells' own reach.
  void find(const CellGrid& grid, const Block& block, float radius,
            std::span<const float> reach_of_cells = {});

  /// The points of all leaves within `radius` of `part`, or within their own reach, in sorted
  /// order. No longer valid after the next call.
  [[nodiscard]] std::span<const simd::Run> near(const Block& part, float radius);

 private:
  void push_back(const CellGrid::Cell& leaf, float reach);

  static constexpr std::size_t kColumns = 7;  // of the next line

  std::array<std::vector<float>, kColumns> columns_;  // lower x, y, z, upper x, y, z, squared reach
  std::vector<simd::Run> leaves_;
  std::vector<simd::Run> runs_;
  std::size_t count_ = 0;
};

/// Pairs of points that are near each other, a part after another; keeps its memory in between.
class NearPairs {
 public:
  /// Calls visit(i, j) for each i of [first, first + count) and each j of the runs within
  /// reach_of(i), m, of it; i itself is one.
  template <class ReachOf, class Visit>
  void each(const CellGrid& grid, std::uint32_t first, std::uint32_t count,
            std::span<const simd::Run> runs, const ReachOf& reach_of, const Visit& visit) {
    simd::Row squared = {};
    for (std::uint32_t q = 0; q < count; ++q) {
      const float reach = reach_of(first + q);
      squared[q] = reach * reach;
    }
    each_hit(make_join(grid, first, count, runs), simd::best_joins().within, squared, visit);
  }

  /// The same where find(join, wanted, hits) returns what is near.
  template <class Find, class Wanted, class Visit>
  void each_hit(const simd::Join& join, const Find& find, const Wanted& wanted,
                const Visit& visit) {
    std::size_t candidates = 1;
    for (std::size_t r = 0; r < join.run_count; ++r) {
      candidates += join.runs[r].end - join.runs[r].begin;
    }
    if (hits_.size() < candidates) hits_.resize(2 * candidates);
    const auto first = static_cast<std::uint32_t>(join.query);
    const std::size_t found = find(join, wanted, hits_.data());
    for (std::size_t h = 0; h < found; ++h) {
      for (std::uint32_t bits = hits_[h].queries; bits != 0; bits &= bits - 1) {
        visit(first + static_cast<std::uint32_t>(std::countr_zero(bits)), hits_[h].candidate);
      }
    }
  }

 private:
  std::vector<simd::Hit> hits_;
};

/// The points that are near each of a part's; keeps its memory in between.
class NearLists {
 public:
  /// Finds the points within `reaches`, m, of each point of [first, first + count); none for 0.
  void find(const CellGrid& grid, std::uint32_t first, std::uint32_t count,
            std::span<const simd::Run> runs, std::span<const float> reaches) {
    for (auto& list : lists_) list.clear();
    const auto own = reaches.subspan(first, count);
    if (*std::max_element(own.begin(), own.end()) <= 0) return;
    pairs_.each(
        grid, first, count, runs, [&](std::uint32_t i) { return reaches[i]; },
        [&](std::uint32_t i, std::uint32_t j) { lists_[i - first].push_back(j); });
  }

  /// Neighbours of the point first + q, in rising order.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t q) const { return lists_[q]; }

 private:
  NearPairs pairs_;
  std::array<std::vector<std::uint32_t>, simd::kQueries> lists_;
};

inline constexpr std::uint32_t kBlockPoints = 256;  ///< of a block, at most (judgement)

/// Calls body(block, surroundings) for all blocks, on every core when there are many.
template <class Body>
void for_each_block(const CellGrid& grid, const Body& body) {
  const std::vector<Block> blocks = make_blocks(grid, kBlockPoints);
  parallel_each_with<Surroundings>(
      blocks.size(), 8, [&](std::size_t b, auto& surroundings) { body(blocks[b], surroundings); });
}

/// Calls body(first, count, runs) for all points of a block, at most simd::kQueries at a time:
/// every point within reach of points [first, first + count) is in `runs`.
template <class Body>
void for_each_part(const CellGrid& grid, const Reach& reach, const Block& block,
                   Surroundings& surroundings, const Body& body) {
  const auto largest = [&](const Block& part) {
    if (reach.of_points.empty()) return 0.f;
    const auto own = reach.of_points.subspan(part.begin, part.size());
    return reach.times * *std::max_element(own.begin(), own.end());
  };
  surroundings.find(grid, block, largest(block), reach.of_cells);
  for (std::uint32_t first = block.begin; first < block.end; first += simd::kQueries) {
    const std::uint32_t last = std::min<std::uint32_t>(first + simd::kQueries, block.end);
    const Block part = make_block(grid, first, last);
    body(first, last - first, surroundings.near(part, largest(part)));
  }
}

/// Calls body(worker, i, near) for all points i whose reach is above 0, on every core when there
/// are many. `near`: the points within that reach, m, in rising order; `make_worker()`: memory of a
/// block.
template <class MakeWorker, class Body>
void for_each_near(const CellGrid& grid, std::span<const float> reaches,
                   const MakeWorker& make_worker, const Body& body) {
  for_each_block(grid, [&](const Block& block, Surroundings& surroundings) {
    auto worker = make_worker();
    NearLists near;
    for_each_part(grid, {.of_points = reaches, .of_cells = {}}, block, surroundings,
                  [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
                    near.find(grid, first, count, runs, reaches);
                    for (std::uint32_t q = 0; q < count; ++q) {
                      if (reaches[first + q] > 0) body(worker, first + q, near.of(q));
                    }
                  });
  });
}

/// for_each_part() of all points, on every core when there are many.
template <class Body>
void for_each_neighborhood(const CellGrid& grid, const Reach& reach, const Body& body) {
  for_each_block(grid, [&](const Block& block, Surroundings& surroundings) {
    for_each_part(grid, reach, block, surroundings, body);
  });
}

}  // namespace palpate::detail
