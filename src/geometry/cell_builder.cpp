// Builds the cells of a CellGrid: bounds, Morton keys, sorting, and splits of full cells.
#include "geometry/cell_builder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "geometry/parallel.hpp"
#include "palpate/base/error.hpp"

namespace palpate::detail {
namespace {

constexpr int kLevels = kKeyBits / 3;  // a bit of each axis a level
// Points, and cells, that a thread takes at once (judgement).
constexpr std::size_t kGrain = std::size_t{1} << 16;
constexpr std::size_t kCellsAtATime = 512;  // see kGrain

// Levels that even out a surface of n points: four children a cell, and some to spare.
int levels_for(std::size_t n) {
  if (n <= 256) return kLevels;
  return std::min(kLevels, (static_cast<int>(std::bit_width(n)) + 1) / 2 + 1);
}

[[noreturn]] void refuse_not_finite(std::span<const Eigen::Vector3f> positions) {
  const auto bad = std::find_if(positions.begin(), positions.end(),
                                [](const Eigen::Vector3f& p) { return !p.allFinite(); });
  throw Error(fmt::format(
      "index: point {} of {} is not finite ({}, {}, {}); drop such points before indexing",
      bad - positions.begin(), positions.size(), bad->x(), bad->y(), bad->z()));
}

// Four points at a time: their twelve numbers side by side fill the processor's lanes.
struct WideBounds {
  static constexpr std::size_t kLanes = 12;  // x, y, z of four points
  std::array<float, kLanes> lower;
  std::array<float, kLanes> upper;
  std::array<std::uint32_t, kLanes> exponents{};

  explicit WideBounds(const Eigen::Vector3f& first) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      lower[l] = upper[l] = first[static_cast<Eigen::Index>(l % 3)];
    }
  }

  void take(const float* numbers) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float v = numbers[l];
      lower[l] = v < lower[l] ? v : lower[l];
      upper[l] = upper[l] < v ? v : upper[l];
      const std::uint32_t exponent = std::bit_cast<std::uint32_t>(v) & 0x7F800000;
      exponents[l] = exponent < exponents[l] ? exponents[l] : exponent;
    }
  }
};

// Twice what a surface of n points makes; room that is not used costs nothing.
std::size_t expected_cells(std::size_t n) {
  return n / 2 + 64;
}

std::size_t bytes_for(std::size_t n) {
  return 2 * n * sizeof(Record) + expected_cells(n) * (sizeof(CellGrid::Cell) + 1) + 64;
}

}  // namespace

void require_finite(std::span<const Eigen::Vector3f> positions) {
  const auto is_finite = [](const Eigen::Vector3f& p) { return p.allFinite(); };
  if (!std::ranges::all_of(positions, is_finite)) refuse_not_finite(positions);
}

CellBuilder::CellBuilder(std::span<const Eigen::Vector3f> positions, const CellGrid::Cube* cube)
    : positions_(positions),
      memory_(bytes_for(positions.size())),
      cells_(&memory_),
      depths_(&memory_) {
  const auto count = static_cast<std::uint32_t>(positions.size());
  if (count == 0) return;
  const Bounds bounds = bounds_of_all();
  records_ = allocate(count);
  scratch_ = allocate(count);
  const int levels = cube != nullptr ? kLevels : levels_for(count);
  make_keys(0, count, cube != nullptr ? *cube : bounds.cube(), levels,
            [](std::size_t i) { return i; });
  sort_records(records_, scratch_, 3 * levels);
  cells_.reserve(expected_cells(count));
  depths_.reserve(expected_cells(count));
  cells_.push_back({bounds.lower, bounds.upper, 0, count, 0, 0});
  depths_.push_back(static_cast<std::uint8_t>(levels));
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) divide(cell);
}

std::span<Record> CellBuilder::allocate(std::size_t count) {
  return {static_cast<Record*>(memory_.allocate(count * sizeof(Record), alignof(Record))), count};
}

CellBuilder::Bounds CellBuilder::bounds_of(const CellGrid::Cell& cell) const {
  const auto at = [&](std::size_t i) { return positions_[records_[i] & kIndexMask]; };
  Bounds bounds{at(cell.begin), at(cell.begin)};
  for (std::size_t i = cell.begin + 1; i < cell.end; ++i) {
    bounds.lower = bounds.lower.cwiseMin(at(i));
    bounds.upper = bounds.upper.cwiseMax(at(i));
  }
  return bounds;
}

CellBuilder::Bounds CellBuilder::bounds_of_all() const {
  WideBounds wide(positions_.front());
  std::size_t i = 0;
  for (; i + 4 <= positions_.size(); i += 4) wide.take(positions_[i].data());
  for (; i < positions_.size(); ++i) {
    const std::array<Eigen::Vector3f, 4> last{positions_[i], positions_[i], positions_[i],
                                              positions_[i]};
    wide.take(last.front().data());
  }
  Bounds bounds{positions_.front(), positions_.front()};
  for (std::size_t l = 0; l < WideBounds::kLanes; ++l) {
    const auto axis = static_cast<Eigen::Index>(l % 3);
    bounds.lower[axis] = std::min(bounds.lower[axis], wide.lower[l]);
    bounds.upper[axis] = std::max(bounds.upper[axis], wide.upper[l]);
    if (wide.exponents[l] == 0x7F800000) refuse_not_finite(positions_);
  }
  return bounds;
}

template <class IndexOf>
void CellBuilder::make_keys(std::uint32_t begin, std::uint32_t end, const CellGrid::Cube& cube,
                            int levels, const IndexOf& index_of) {
  const Eigen::Vector3d lower = cube.lower;
  const double steps = std::ldexp(1., levels);
  const double scale = cube.edge > 0 ? steps / cube.edge : 0;
  const int shift = kIndexBits + kKeyBits - 3 * levels;
  parallel_ranges(end - begin, kGrain, [&](std::size_t from, std::size_t to) {
    const auto cell = [&](double v, double low) {
      return static_cast<std::uint32_t>(std::clamp((v - low) * scale, 0., steps - 1));
    };
    for (std::size_t i = begin + from; i < begin + to; ++i) {
      const std::uint64_t index = index_of(i);
      const Eigen::Vector3f& p = positions_[index];
      const std::uint64_t key =
          morton_key(cell(p.x(), lower.x()), cell(p.y(), lower.y()), cell(p.z(), lower.z()));
      records_[i] = key << shift | index;
    }
  });
}

void CellBuilder::divide(std::size_t cell) {
  if (cells_[cell].size() <= CellGrid::kLeafPoints) return;
  const auto difference = [&] {
    return (records_[cells_[cell].begin] ^ records_[cells_[cell].end - 1]) >> kIndexBits;
  };
  if (difference() == 0 && !sort_again(cell)) return;
  const int level = (static_cast<int>(std::bit_width(difference())) - 1) / 3;
  append_children(cell, kIndexBits + 3 * level);
}

// False when the cell's points coincide, or its keys may have no more levels.
bool CellBuilder::sort_again(std::size_t cell) {
  const auto [begin, end] = std::pair(cells_[cell].begin, cells_[cell].end);
  const Bounds bounds = bounds_of(cells_[cell]);
  const int levels = std::min(levels_for(end - begin), CellGrid::kMaxDepth - depths_[cell]);
  if (bounds.lower == bounds.upper || levels <= 0) return false;
  make_keys(begin, end, bounds.cube(), levels,
            [this](std::size_t i) { return records_[i] & kIndexMask; });
  sort_records(records_.subspan(begin, end - begin), scratch_.subspan(begin, end - begin),
               3 * levels);
  depths_[cell] = static_cast<std::uint8_t>(depths_[cell] + levels);
  return true;
}

void CellBuilder::append_children(std::size_t cell, int shift) {
  const auto first_child = static_cast<std::uint32_t>(cells_.size());
  const std::uint32_t end = cells_[cell].end;
  const std::uint8_t depth = depths_[cell];
  std::uint32_t begin = cells_[cell].begin;
  while (begin < end) {
    const Record group = records_[begin] >> shift;
    std::uint32_t next = end;
    if (end - begin > 64) {
      const auto after =
          std::partition_point(records_.begin() + begin, records_.begin() + end,
                               [&](Record record) { return (record >> shift) == group; });
      next = static_cast<std::uint32_t>(after - records_.begin());
    } else {
      next = begin + 1;
      while (next < end && (records_[next] >> shift) == group) ++next;
    }
    cells_.push_back({Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), begin, next, 0, 0});
    depths_.push_back(depth);
    begin = next;
  }
  cells_[cell].first_child = first_child;
  cells_[cell].children = static_cast<std::uint32_t>(cells_.size()) - first_child;
}

std::vector<std::uint32_t> CellBuilder::order() const {
  std::vector<std::uint32_t> order(records_.size());
  parallel_each(order.size(), kGrain, [&](std::size_t i) {
    order[i] = static_cast<std::uint32_t>(records_[i] & kIndexMask);
  });
  return order;
}

std::vector<Eigen::Vector3f> CellBuilder::points() const {
  std::vector<Eigen::Vector3f> points(records_.size());
  parallel_each(points.size(), kGrain,
                [&](std::size_t i) { points[i] = positions_[records_[i] & kIndexMask]; });
  return points;
}

std::vector<CellGrid::Cell> CellBuilder::cells() const {
  return {cells_.begin(), cells_.end()};
}

void fit_boxes(std::span<const Eigen::Vector3f> points, std::span<CellGrid::Cell> cells,
               std::span<const Eigen::Vector3f> ends) {
  parallel_each(cells.size(), kCellsAtATime, [&](std::size_t i) {
    CellGrid::Cell& cell = cells[i];
    if (cell.children != 0) return;
    cell.lower = cell.upper = points[cell.begin];
    for (std::uint32_t k = cell.begin + 1; k < cell.end; ++k) {
      cell.lower = cell.lower.cwiseMin(points[k]);
      cell.upper = cell.upper.cwiseMax(points[k]);
    }
    for (std::uint32_t k = cell.begin; !ends.empty() && k < cell.end; ++k) {
      cell.lower = cell.lower.cwiseMin(ends[k]);
      cell.upper = cell.upper.cwiseMax(ends[k]);
    }
  });
  for (std::size_t i = cells.size(); i-- > 0;) {
    CellGrid::Cell& cell = cells[i];
    if (cell.children == 0) continue;
    cell.lower = cells[cell.first_child].lower;
    cell.upper = cells[cell.first_child].upper;
    for (std::uint32_t c = 1; c < cell.children; ++c) {
      cell.lower = cell.lower.cwiseMin(cells[cell.first_child + c].lower);
      cell.upper = cell.upper.cwiseMax(cells[cell.first_child + c].upper);
    }
  }
}

}  // namespace palpate::detail
