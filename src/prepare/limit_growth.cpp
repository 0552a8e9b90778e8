#include "prepare/limit_growth.hpp"

#include <algorithm>
#include <array>

#include "geometry/parallel.hpp"

namespace palpate {
namespace {

constexpr float kSlope = 0.5f;    // of R over distance
constexpr float kMatters = 0.8f;  // of the own R: a smaller limit is worth looking for

std::vector<float> smallest_in_cells(const CellGrid& grid, const std::vector<float>& radii) {
  const auto cells = grid.cells();
  std::vector<float> smallest(cells.size());
  for (std::size_t c = cells.size(); c-- > 0;) {  // children stand behind their parents
    const CellGrid::Cell& cell = cells[c];
    smallest[c] = cell.children > 0
                      ? smallest[cell.first_child]
                      : *std::min_element(radii.begin() + cell.begin, radii.begin() + cell.end);
    for (std::uint32_t k = 1; k < cell.children; ++k) {
      smallest[c] = std::min(smallest[c], smallest[cell.first_child + k]);
    }
  }
  return smallest;
}

float distance_to(const CellGrid::Cell& cell, const Eigen::Vector3f& p) {
  const Eigen::Array3f outside = (cell.lower - p).array().max((p - cell.upper).array()).max(0.0f);
  return outside.matrix().norm();
}

/// min_j (R_j + distance / 2), by branch and bound over the cells.
float limit_at(const CellGrid& grid, const std::vector<float>& radii,
               const std::vector<float>& smallest, std::uint32_t i) {
  const Eigen::Vector3f p = grid.points()[i];
  float limit = kMatters * radii[i];
  std::array<std::uint32_t, CellGrid::kMaxStack> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const CellGrid::Cell& cell = grid.cells()[index];
    if (smallest[index] >= limit) continue;
    if (smallest[index] + kSlope * distance_to(cell, p) >= limit) continue;
    for (std::uint32_t k = 0; k < cell.children; ++k) stack[size++] = cell.first_child + k;
    if (cell.children > 0) continue;
    for (std::uint32_t j = cell.begin; j < cell.end; ++j) {
      limit = std::min(limit, radii[j] + kSlope * (grid.points()[j] - p).norm());
    }
  }
  return limit < kMatters * radii[i] ? limit : radii[i];
}

}  // namespace

void limit_growth(const CellGrid& grid, std::vector<float>& radii) {
  if (radii.empty()) return;
  const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
  if (*low >= kMatters * *high) return;
  const std::vector<float> smallest = smallest_in_cells(grid, radii);
  std::vector<float> limited(radii.size());
  detail::parallel_ranges(radii.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      limited[i] = limit_at(grid, radii, smallest, static_cast<std::uint32_t>(i));
    }
  });
  radii = std::move(limited);
}

}  // namespace palpate
