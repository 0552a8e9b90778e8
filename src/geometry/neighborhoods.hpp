#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
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

/// Calls visit(part) for the parts of a block: simd::kQueries points, fewer in the last. Their
/// boxes are not set.
template <class Visit>
void for_each_part(const Block& block, const Visit& visit) {
  for (std::uint32_t first = block.begin; first < block.end; first += simd::kQueries) {
    visit(Block{.begin = first, .end = std::min<std::uint32_t>(first + simd::kQueries, block.end)});
  }
}

/// Points that stand together, at most simd::kQueries, and their neighbours: all points that one of
/// them reaches, or that reach one of them, and maybe others.
struct NeighborRow {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::span<const std::uint32_t> neighbors;  ///< in rising order, those points themselves included

  [[nodiscard]] simd::Join join(const CellGrid& grid) const {
    return {grid.points().front().data(), first, count, neighbors.data(), neighbors.size()};
  }
};

/// Finds rows in a block: gathers the leaves around it once.
class Surroundings {
 public:
  /// Finds the leaves within `radius` of the block, or within the cells' own reach, m; below 0:
  /// none.
  void find(const CellGrid& grid, const Block& block, float radius,
            std::span<const float> reach_of_cells = {});

  [[nodiscard]] bool empty() const { return count_ == 0; }

  /// All points of the leaves within `radius` of a part of the block, or within their own reach, m.
  /// No longer valid after the next call.
  [[nodiscard]] NeighborRow row(const Block& part, float radius);

  /// The neighbours of a part alone: those within the root of its `squared_radii` of each, or of
  /// `squared_supports` of the neighbour (empty: 0), m^2. No longer valid after the next call.
  [[nodiscard]] NeighborRow sifted_row(const CellGrid& grid, const Block& part,
                                       const simd::Row& squared_radii,
                                       std::span<const float> squared_supports);

 private:
  void push_back(const CellGrid::Cell& leaf, float reach);
  [[nodiscard]] std::span<const simd::Run> near(const Block& part, float squared_radius);
  [[nodiscard]] std::span<const simd::Run> near_with_room(const Block& part, float squared_radius);

  static constexpr std::size_t kColumns = 7;  // of the next line

  std::array<std::vector<float>, kColumns> columns_;  // lower x, y, z, upper x, y, z, squared reach
  std::vector<simd::Run> leaves_;
  std::vector<simd::Run> runs_;
  std::vector<std::uint32_t> found_;
  std::size_t count_ = 0;
};

inline constexpr std::uint32_t kBlockPoints = 256;  ///< of a block, at most (judgement)

}  // namespace palpate::detail
