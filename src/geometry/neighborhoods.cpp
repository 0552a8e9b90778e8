// Gathers the cells around blocks of points, so that one walk of the tree serves many points.
#include "geometry/neighborhoods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate::detail {
namespace {

/// Squares a reach, m; one below 0 stays so, and no squared distance is within it.
float square(float reach) {
  return reach * std::abs(reach);
}

}  // namespace

Block make_block(const CellGrid& grid, std::uint32_t begin, std::uint32_t end) {
  Block block{begin, end, grid.points()[begin], grid.points()[begin]};
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    block.lower = block.lower.cwiseMin(grid.points()[i]);
    block.upper = block.upper.cwiseMax(grid.points()[i]);
  }
  return block;
}

std::vector<Block> make_blocks(const CellGrid& grid, std::uint32_t most) {
  const std::span<const CellGrid::Cell> cells = grid.cells();
  std::vector<Block> blocks;
  blocks.reserve(2 * (grid.size() / most) + 1);
  std::array<std::uint32_t, CellGrid::kMaxStack> stack;
  std::size_t open = 0;
  if (!cells.empty()) stack[open++] = 0;
  while (open > 0) {
    const CellGrid::Cell& cell = cells[stack[--open]];
    if (cell.size() <= most) {
      blocks.push_back({cell.begin, cell.end, cell.lower, cell.upper});
      continue;
    }
    for (std::uint32_t c = cell.children; c-- > 0;) stack[open++] = cell.first_child + c;
    if (cell.children != 0) continue;
    for (std::uint32_t i = cell.begin; i < cell.end; i += most) {
      blocks.push_back(make_block(grid, i, std::min(i + most, cell.end)));
    }
  }
  return blocks;
}

void Surroundings::push_back(const CellGrid::Cell& leaf, float reach) {
  if (count_ == leaves_.size()) {
    const std::size_t room = 2 * count_ + 8 * simd::kQueries;
    for (auto& column : columns_) column.resize(room);
    leaves_.resize(room);
    runs_.resize(room + 1);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    columns_[axis][count_] = leaf.lower[static_cast<Eigen::Index>(axis)];
    columns_[axis + 3][count_] = leaf.upper[static_cast<Eigen::Index>(axis)];
  }
  columns_[6][count_] = square(reach);
  leaves_[count_++] = {leaf.begin, leaf.end};
}

void Surroundings::find(const CellGrid& grid, const Block& block, float radius,
                        std::span<const float> reach_of_cells) {
  const std::span<const CellGrid::Cell> cells = grid.cells();
  const auto reach_of = [&](std::uint32_t cell) {
    return reach_of_cells.empty() ? -1.f : reach_of_cells[cell];
  };
  std::array<std::uint32_t, CellGrid::kMaxStack> stack;
  std::size_t open = 0;
  if (!cells.empty()) stack[open++] = 0;
  count_ = 0;
  while (open > 0) {
    const std::uint32_t index = stack[--open];
    const CellGrid::Cell& cell = cells[index];
    if (cell.children == 0) push_back(cell, reach_of(index));
    for (std::uint32_t c = cell.children; c-- > 0;) {
      const std::uint32_t child = cell.first_child + c;
      const float reach = std::max(radius, reach_of(child));
      stack[open] = child;  // no branch: whether a cell is near cannot be foretold
      open += squared_distance(cells[child], block.lower, block.upper) <= square(reach) ? 1 : 0;
    }
  }
  CellGrid::Cell nowhere;
  nowhere.lower = nowhere.upper = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
  while (count_ % simd::kQueries != 0) push_back(nowhere, 0);
}

std::span<const simd::Run> Surroundings::near(const Block& part, float squared_radius) {
  if (count_ == 0) return {};
  const simd::Leaves leaves{
      .lower = {columns_[0].data(), columns_[1].data(), columns_[2].data()},
      .upper = {columns_[3].data(), columns_[4].data(), columns_[5].data()},
      .squared_reach = columns_[6].data(),
      .points = leaves_.data(),
      .count = count_,
  };
  const std::size_t runs = simd::best_joins().near(leaves, part.lower.data(), part.upper.data(),
                                                   squared_radius, runs_.data());
  return std::span<const simd::Run>(runs_).subspan(1, runs);
}

std::span<const simd::Run> Surroundings::near_with_room(const Block& part, float squared_radius) {
  const std::span<const simd::Run> runs = near(part, squared_radius);
  std::size_t most = 1;
  for (const simd::Run& run : runs) most += run.end - run.begin;
  if (found_.size() < most) found_.resize(2 * most);
  return runs;
}

NeighborRow Surroundings::row(const Block& part, float radius) {
  std::size_t count = 0;
  for (const simd::Run& run : near_with_room(part, radius * radius)) {
    for (std::uint32_t j = run.begin; j < run.end; ++j) found_[count++] = j;
  }
  return {part.begin, part.size(), std::span<const std::uint32_t>(found_).first(count)};
}

NeighborRow Surroundings::sifted_row(const CellGrid& grid, const Block& part,
                                     const simd::Row& squared_radii,
                                     std::span<const float> squared_supports) {
  const float largest = *std::max_element(squared_radii, squared_radii + part.size());
  const std::span<const simd::Run> runs = near_with_room(part, largest);
  NeighborRow row{part.begin, part.size(), {}};
  const simd::Search search{
      .runs = runs.data(),
      .run_count = runs.size(),
      .squared_reaches = squared_radii,
      .squared_own = squared_supports.empty() ? nullptr : squared_supports.data(),
  };
  const std::size_t count = simd::best_joins().gather(row.join(grid), search, found_.data());
  row.neighbors = std::span<const std::uint32_t>(found_).first(count);
  return row;
}

}  // namespace palpate::detail
