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
          fmt::format("weight sums: a radius of {} m; all must be positive and finite", radius));
    }
  }
}

// For each point i the sum of w_ij values_j over all points j; no values: of w_ij.
std::vector<float> sums_of(const CellGrid& grid, std::span<const float> radii,
                           std::span<const float> cell_reach, WeightSum sum,
                           std::span<const float> values) {
  std::vector<float> sums(grid.size());
  for_each_group(grid, [&](const Group& group, JoinSpace& space) {
    space.ask_for(grid, group);
    gather_reaching(grid, group, radii, cell_reach, space.candidates);
    for (auto& column : space.values) column.clear();
    for (const std::uint32_t j : space.candidates.indices()) {
      space.values[0].push_back(std::min(1 / (radii[j] * radii[j]), kLargest));
      space.values[1].push_back(values.empty() ? 1 : values[j]);
    }
    sum(space.queries.coordinates(), space.candidates.coordinates(), space.values[0].data(),
        space.values[1].data(), space.rows[0]);
    std::copy_n(space.rows[0], group.size(), sums.begin() + group.begin);
  });
  return sums;
}

}  // namespace

WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii, WeightSum sum) {
  check(grid, radii);
  const std::vector<float> cell_reach = largest_in_cells(grid, radii);
  WeightSums sums;
  sums.own = sums_of(grid, radii, cell_reach, sum, {});
  sums.around = sums_of(grid, radii, cell_reach, sum, sums.own);
  for (std::size_t i = 0; i < sums.own.size(); ++i) sums.around[i] /= sums.own[i];
  return sums;
}

}  // namespace palpate::detail
