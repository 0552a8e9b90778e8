// Builds a CellGrid and searches it: nearest neighbours, points within a radius.
#include "palpate/geometry/cell_grid.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <numeric>
#include <utility>

#include "geometry/cell_builder.hpp"
#include "geometry/neighborhoods.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

struct Candidate {
  float squared_distance;
  std::uint32_t cell;
};

// No function: heaps call a pointer to one, and inline this.
constexpr auto kNearer = [](const CellGrid::Neighbor& a, const CellGrid::Neighbor& b) {
  return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                  : a.index < b.index;
};

// Keeps the k nearest in a heap with the farthest in front.
void offer(std::vector<CellGrid::Neighbor>& heap, std::size_t k,
           const CellGrid::Neighbor& neighbor) {
  if (heap.size() < k) {
    heap.push_back(neighbor);
    std::push_heap(heap.begin(), heap.end(), kNearer);
  } else if (kNearer(neighbor, heap.front())) {
    std::pop_heap(heap.begin(), heap.end(), kNearer);
    heap.back() = neighbor;
    std::push_heap(heap.begin(), heap.end(), kNearer);
  }
}

// A walk's open cells. Children go on it farthest first, so that the nearest comes off first.
class Stack {
 public:
  [[nodiscard]] bool empty() const { return count_ == 0; }
  Candidate pop() { return entries_[--count_]; }
  void push(const Candidate& candidate) { entries_[count_++] = candidate; }
  void push_sorted(std::span<const CellGrid::Cell> cells, const CellGrid::Cell& cell,
                   const Eigen::Vector3f& center) {
    const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(count_);
    for (std::uint32_t c = 0; c < cell.children; ++c) {
      const std::uint32_t child = cell.first_child + c;
      push({detail::squared_distance(cells[child], center), child});
    }
    std::sort(first, first + cell.children, [](const Candidate& a, const Candidate& b) {
      return a.squared_distance > b.squared_distance;
    });
  }

 private:
  std::array<Candidate, CellGrid::kMaxStack> entries_;
  std::size_t count_ = 0;
};

}  // namespace

CellGrid::CellGrid(std::span<const Eigen::Vector3f> positions) : CellGrid(positions, nullptr) {}

CellGrid::CellGrid(std::span<const Eigen::Vector3f> positions, const Cube& cube)
    : CellGrid(positions, &cube) {}

CellGrid::CellGrid(std::span<const Eigen::Vector3f> positions, const Cube* cube) {
  if (positions.size() > detail::kIndexMask) {
    throw Error(fmt::format("index: {} points exceed the limit of {}; downsample them",
                            positions.size(), detail::kIndexMask));
  }
  const detail::CellBuilder builder(positions, cube);
  order_ = builder.order();
  points_ = builder.points();
  cells_ = builder.cells();
  detail::fit_boxes(points_, cells_);
}

void CellGrid::rebuild(std::span<const Eigen::Vector3f> positions,
                       std::span<const std::uint32_t> codes,
                       std::span<const Eigen::Vector3f> ends) {
  assert(positions.size() == codes.size() && std::is_sorted(codes.begin(), codes.end()));
  points_.resize(positions.size());  // grows by more than assign() does: counts vary
  std::ranges::copy(positions, points_.begin());
  order_.resize(positions.size());
  std::iota(order_.begin(), order_.end(), 0u);
  cells_.clear();
  if (positions.empty()) return;
  const Eigen::Vector3f zero = Eigen::Vector3f::Zero();
  cells_.push_back({zero, zero, 0, static_cast<std::uint32_t>(positions.size()), 0, 0});
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (cells_[cell].size() > kLeafPoints) divide(cell, codes);
  }
  detail::fit_boxes(points_, cells_, ends);
}

void CellGrid::divide(std::size_t cell, std::span<const std::uint32_t> codes) {
  const auto [begin, end] = std::pair(cells_[cell].begin, cells_[cell].end);
  const std::uint32_t difference = codes[begin] ^ codes[end - 1];
  if (difference == 0) return;
  const int shift = (static_cast<int>(std::bit_width(difference)) - 1) / 2 * 2;
  const auto first_child = static_cast<std::uint32_t>(cells_.size());
  for (std::uint32_t from = begin; from < end;) {
    const std::uint32_t group = codes[from] >> shift;
    const auto next =
        std::partition_point(codes.begin() + from, codes.begin() + end,
                             [&](std::uint32_t code) { return code >> shift == group; });
    const auto to = static_cast<std::uint32_t>(next - codes.begin());
    cells_.push_back({Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), from, to, 0, 0});
    from = to;
  }
  cells_[cell].first_child = first_child;
  cells_[cell].children = static_cast<std::uint32_t>(cells_.size()) - first_child;
}

void CellGrid::within(const Eigen::Vector3f& center, float radius,
                      std::vector<std::uint32_t>& found, std::size_t most) const {
  if (cells_.empty() || !(radius >= 0)) return;
  const float squared_radius = radius * radius;
  std::array<std::uint32_t, kMaxStack> stack;
  std::size_t open = 0;
  stack[open++] = 0;
  std::size_t count = found.size();
  while (open > 0 && count < most) {
    const Cell& cell = cells_[stack[--open]];
    const bool inside = detail::largest_squared_distance(cell, center) <= squared_radius;
    for (std::uint32_t c = inside ? 0 : cell.children; c-- > 0;) {
      stack[open] = cell.first_child + c;  // no branch: whether a cell is near cannot be foretold
      open += detail::squared_distance(cells_[stack[open]], center) <= squared_radius ? 1 : 0;
    }
    if (!inside && cell.children != 0) continue;
    const auto size = static_cast<std::uint32_t>(
        inside ? std::min<std::size_t>(cell.size(), most - count) : cell.size());
    if (count + size > found.size()) found.resize(2 * (count + size));
    for (std::uint32_t i = cell.begin; i < cell.begin + size; ++i) {  // no branch: hits are random
      found[count] = i;
      count += inside || detail::squared_distance(points_[i], center) <= squared_radius ? 1 : 0;
    }
  }
  found.resize(count);
}

void CellGrid::nearest(const Eigen::Vector3f& center, std::size_t k,
                       std::vector<Neighbor>& found) const {
  found.clear();
  k = std::min(k, size());
  if (k == 0) return;
  Stack stack;
  stack.push({detail::squared_distance(cells_.front(), center), 0});
  while (!stack.empty()) {
    const Candidate next = stack.pop();
    if (found.size() == k && next.squared_distance > found.front().squared_distance) continue;
    const Cell& cell = cells_[next.cell];
    if (cell.children != 0) {
      stack.push_sorted(cells_, cell, center);
      continue;
    }
    // Ties go by index: of points at one position only the first ones can be among the nearest.
    const auto most =
        cell.lower == cell.upper ? std::min<std::size_t>(k, cell.size()) : cell.size();
    for (std::uint32_t i = cell.begin; i < cell.begin + most; ++i) {
      offer(found, k, {i, detail::squared_distance(points_[i], center)});
    }
  }
  std::sort_heap(found.begin(), found.end(), kNearer);
}

}  // namespace palpate
