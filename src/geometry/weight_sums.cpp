#include "geometry/weight_sums.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/neighborhoods.hpp"
#include "palpate/base/error.hpp"

namespace palpate::detail {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();

void check(const CellGrid& grid, std::span<const float> radii) {
  if (radii.size() != grid.size()) {
    throw Error(fmt::format("weight sums: {} radii for {} points; give one for each", radii.size(),
                            grid.size()));
  }
  for (const float radius : radii) {
    if (!(radius > 0) || !std::isfinite(radius)) {
      throw Error(
          fmt::format("weight sums: a radius is {} m; all must be positive and finite", radius));
    }
  }
}

struct Input {
  const CellGrid& grid;
  std::vector<float> inverse;     // 1 / R_i^2
  std::vector<float> cell_reach;  // m
};

Input make_input(const CellGrid& grid, std::span<const float> radii) {
  Input input{grid, std::vector<float>(grid.size()), largest_in_cells(grid, radii)};
  std::transform(radii.begin(), radii.end(), input.inverse.begin(),
                 [](float radius) { return std::min(1 / (radius * radius), kLargest); });
  return input;
}

// For each point i the sum of w_ij values_j over all points j; no values: all 1.
std::vector<float> sums_of(const Input& input, WeightSum sum, std::span<const float> values) {
  std::vector<float> sums(input.grid.size());
  for_each_neighborhood(
      input.grid, {.of_points = {}, .times = 1, .of_cells = input.cell_reach},
      [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
        simd::Row row;
        sum(make_join(input.grid, first, count, runs), input.inverse.data(), values.data(), &row);
        std::copy_n(row, count, sums.begin() + first);
      });
  return sums;
}

}  // namespace

WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii, WeightSum sum) {
  check(grid, radii);
  const Input input = make_input(grid, radii);
  WeightSums sums;
  sums.own = sums_of(input, sum, {});
  sums.around = sums_of(input, sum, sums.own);
  parallel_ranges(grid.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) sums.around[i] /= sums.own[i];
  });
  return sums;
}

}  // namespace palpate::detail
