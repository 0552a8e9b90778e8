#include "palpate/field/density.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/neighborhoods.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using detail::Group;
using detail::JoinSpace;

constexpr float kShareOfAround = 0.8f;
constexpr float kLargest = std::numeric_limits<float>::max();

void check(const CellGrid& grid, std::span<const float> radii) {
  if (radii.size() != grid.size()) {
    throw Error(fmt::format("density weights: {} radii for {} points; give one for each",
                            radii.size(), grid.size()));
  }
  for (const float radius : radii) {
    if (!(radius > 0) || !std::isfinite(radius)) {
      throw Error(fmt::format(
          "density weights: a radius of {} m; every one must be positive and finite", radius));
    }
  }
}

// For each point i the sum of w(|p_i - p_j| / R_j) values_j over all points j.
std::vector<float> sums_of(const CellGrid& grid, std::span<const float> radii, Kernel kernel,
                           std::span<const float> values) {
  const std::vector<float> cell_reach = detail::largest_in_cells(grid, radii);
  const auto sum =
      kernel == Kernel::wyvill ? simd::best_joins().wyvill_sums : simd::best_joins().wendland_sums;
  std::vector<float> sums(grid.size());
  detail::for_each_group(grid, [&](const Group& group, JoinSpace& space) {
    space.ask_for(grid, group);
    detail::gather_reaching(grid, group, radii, cell_reach, space.candidates);
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

WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii, Kernel kernel) {
  check(grid, radii);
  WeightSums sums;
  sums.own = sums_of(grid, radii, kernel, {});
  sums.around = sums_of(grid, radii, kernel, sums.own);
  for (std::size_t i = 0; i < sums.own.size(); ++i) sums.around[i] /= sums.own[i];
  return sums;
}

std::vector<float> density_weights(const CellGrid& grid, std::span<const float> radii,
                                   Kernel kernel) {
  const WeightSums sums = weight_sums(grid, radii, kernel);
  std::vector<float> weights(grid.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 1 / std::max(sums.own[i], kShareOfAround * sums.around[i]);
  }
  return weights;
}

}  // namespace palpate
