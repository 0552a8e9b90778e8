#include "geometry/neighborhoods.hpp"

#include <algorithm>

#include "geometry/distance.hpp"

namespace palpate::detail {
namespace {

static_assert(kGroupPoints % simd::kQueryStep == 0);

Group group_of(const CellGrid& grid, std::uint32_t begin, std::uint32_t end) {
  Group group{begin, end, grid.points()[begin], grid.points()[begin]};
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    group.lower = group.lower.cwiseMin(grid.points()[i]);
    group.upper = group.upper.cwiseMax(grid.points()[i]);
  }
  return group;
}

// Calls visit(cell) for the leaves that `wanted` lets through, in sorted order.
template <class Wanted, class Visit>
void walk(const CellGrid& grid, const Wanted& wanted, const Visit& visit) {
  const std::span<const CellGrid::Cell> cells = grid.cells();
  std::array<std::uint32_t, CellGrid::kMaxStack> stack;
  std::size_t open = 0;
  if (!cells.empty()) stack[open++] = 0;
  while (open > 0) {
    const std::uint32_t index = stack[--open];
    const CellGrid::Cell& cell = cells[index];
    if (!wanted(index)) continue;
    if (cell.children == 0) visit(cell);
    for (std::uint32_t c = cell.children; c-- > 0;) stack[open++] = cell.first_child + c;
  }
}

float squared_gap(const Group& group, const Eigen::Vector3f& p) {
  const float x = gap(group.lower.x(), group.upper.x(), p.x(), p.x());
  const float y = gap(group.lower.y(), group.upper.y(), p.y(), p.y());
  const float z = gap(group.lower.z(), group.upper.z(), p.z(), p.z());
  return x * x + y * y + z * z;
}

}  // namespace

std::vector<Group> make_groups(const CellGrid& grid) {
  const std::span<const CellGrid::Cell> cells = grid.cells();
  std::vector<Group> groups;
  groups.reserve(grid.size() / (kGroupPoints / 2) + 8);
  std::array<std::uint32_t, CellGrid::kMaxStack> stack;
  std::size_t open = 0;
  if (!cells.empty()) stack[open++] = 0;
  while (open > 0) {
    const CellGrid::Cell& cell = cells[stack[--open]];
    if (cell.size() <= kGroupPoints) {
      groups.push_back({cell.begin, cell.end, cell.lower, cell.upper});
      continue;
    }
    for (std::uint32_t c = cell.children; c-- > 0;) stack[open++] = cell.first_child + c;
    if (cell.children != 0) continue;
    for (std::uint32_t i = cell.begin; i < cell.end; i += kGroupPoints) {
      groups.push_back(group_of(grid, i, std::min(i + kGroupPoints, cell.end)));
    }
  }
  return groups;
}

void Columns::reserve(std::size_t count) {
  if (count <= x_.size()) return;
  count = std::max(count, 2 * x_.size());
  indices_.reserve(count);
  x_.resize(count);
  y_.resize(count);
  z_.resize(count);
}

void Columns::push_back(std::uint32_t index, const Eigen::Vector3f& p) {
  const std::size_t i = indices_.size();
  reserve(i + 1);
  indices_.push_back(index);
  x_[i] = p.x();
  y_[i] = p.y();
  z_[i] = p.z();
}

void Columns::pad() {
  while (size() % simd::kQueryStep != 0) {
    const std::size_t last = size() - 1;
    push_back(indices_[last], {x_[last], y_[last], z_[last]});
  }
}

simd::Coordinates Columns::coordinates() const {
  return {x_.data(), y_.data(), z_.data(), size()};
}

bool gather(const CellGrid& grid, const Group& group, float radius, Columns& found,
            std::size_t limit) {
  const float squared_radius = radius * radius;
  found.clear();
  walk(
      grid,
      [&](std::uint32_t cell) {
        return found.size() <= limit &&
               squared_distance(grid.cells()[cell], group.lower, group.upper) <= squared_radius;
      },
      [&](const CellGrid::Cell& leaf) {
        found.reserve(found.size() + leaf.size());
        for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
          const Eigen::Vector3f& p = grid.points()[i];
          if (squared_gap(group, p) <= squared_radius) found.push_back(i, p);
        }
      });
  return found.size() <= limit;
}

void gather_reaching(const CellGrid& grid, const Group& group, std::span<const float> radii,
                     std::span<const float> cell_reach, Columns& found) {
  found.clear();
  walk(
      grid,
      [&](std::uint32_t cell) {
        return squared_distance(grid.cells()[cell], group.lower, group.upper) <=
               cell_reach[cell] * cell_reach[cell];
      },
      [&](const CellGrid::Cell& leaf) {
        found.reserve(found.size() + leaf.size());
        for (std::uint32_t i = leaf.begin; i < leaf.end; ++i) {
          const Eigen::Vector3f& p = grid.points()[i];
          if (squared_gap(group, p) <= radii[i] * radii[i]) found.push_back(i, p);
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

JoinSpace::JoinSpace() {
  for (std::size_t k = 0; k < kRows; ++k) rows[k] = results[k].data();
}

void JoinSpace::ask_for(const CellGrid& grid, const Group& group) {
  queries.clear();
  for (std::uint32_t i = group.begin; i < group.end; ++i) queries.push_back(i, grid.points()[i]);
  queries.pad();
}

}  // namespace palpate::detail
