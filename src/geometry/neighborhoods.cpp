#include "geometry/neighborhoods.hpp"

#include <algorithm>
#include <array>

#include "geometry/distance.hpp"

namespace palpate::detail {

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

std::vector<float> make_column(std::size_t size) {
  return std::vector<float>(size + simd::kQueries, 0.f);
}

Columns::Columns(const CellGrid& grid)
    : x_(make_column(grid.size())), y_(make_column(grid.size())), z_(make_column(grid.size())) {
  parallel_ranges(grid.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      x_[i] = grid.points()[i].x();
      y_[i] = grid.points()[i].y();
      z_[i] = grid.points()[i].z();
    }
  });
}

std::vector<float> largest_in_cells(const CellGrid& grid, std::span<const float> values) {
  const std::span<const CellGrid::Cell> cells = grid.cells();
  std::vector<float> largest(cells.size());
  for (std::size_t c = cells.size(); c-- > 0;) {
    const CellGrid::Cell& cell = cells[c];
    const auto inside = cell.children == 0 ? values.subspan(cell.begin, cell.size())
                                           : std::span<const float>(largest).subspan(
                                                 cell.first_child, cell.children);
    largest[c] = *std::max_element(inside.begin(), inside.end());
  }
  return largest;
}

void Surroundings::find(const CellGrid& grid, const Block& block, float radius,
                        std::span<const float> reach_of_cells) {
  for (auto* column :
       {&lower_x_, &lower_y_, &lower_z_, &upper_x_, &upper_y_, &upper_z_, &squared_reach_}) {
    column->clear();
  }
  leaves_.clear();
  points_ = 0;
  const std::span<const CellGrid::Cell> cells = grid.cells();
  std::array<std::uint32_t, CellGrid::kMaxStack> stack;
  std::size_t open = 0;
  if (!cells.empty()) stack[open++] = 0;
  while (open > 0) {
    const std::uint32_t index = stack[--open];
    const CellGrid::Cell& cell = cells[index];
    const float own = reach_of_cells.empty() ? 0 : reach_of_cells[index];
    const float reach = std::max(radius, own);
    if (squared_distance(cell, block.lower, block.upper) > reach * reach) continue;
    for (std::uint32_t c = cell.children; c-- > 0;) stack[open++] = cell.first_child + c;
    if (cell.children != 0) continue;
    lower_x_.push_back(cell.lower.x());
    lower_y_.push_back(cell.lower.y());
    lower_z_.push_back(cell.lower.z());
    upper_x_.push_back(cell.upper.x());
    upper_y_.push_back(cell.upper.y());
    upper_z_.push_back(cell.upper.z());
    squared_reach_.push_back(own * own);
    leaves_.push_back({cell.begin, cell.end});
    points_ += cell.size();
  }
}

std::span<const simd::Run> Surroundings::near(const Block& part, float radius) {
  const float squared_radius = radius * radius;
  const Eigen::Vector3f lower = part.lower;
  const Eigen::Vector3f upper = part.upper;
  near_.resize(leaves_.size());
  for (std::size_t k = 0; k < near_.size(); ++k) {
    const float x = gap(lower_x_[k], upper_x_[k], lower.x(), upper.x());
    const float y = gap(lower_y_[k], upper_y_[k], lower.y(), upper.y());
    const float z = gap(lower_z_[k], upper_z_[k], lower.z(), upper.z());
    const float reach = std::max(squared_radius, squared_reach_[k]);
    near_[k] = x * x + y * y + z * z <= reach ? 1 : 0;
  }
  runs_.clear();
  for (std::size_t k = 0; k < near_.size(); ++k) {
    if (near_[k] == 0) continue;
    if (!runs_.empty() && runs_.back().end == leaves_[k].begin) {
      runs_.back().end = leaves_[k].end;
    } else {
      runs_.push_back(leaves_[k]);
    }
  }
  return runs_;
}

}  // namespace palpate::detail
