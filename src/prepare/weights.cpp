// Weighs points by how many others share their surface.

#include "prepare/weights.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/near_pairs.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using WeightSum = decltype(simd::JoinFunctions::wyvill_sums);

constexpr float kLargest = std::numeric_limits<float>::max();  // 1/m^2: 1 / R^2 stays finite
constexpr std::size_t kFewestOthers = 3;  // points; with fewer: a radius outlier; judgement

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

/// The kernel, and what its supports are.
struct Input {
  const detail::NeighborhoodGraph& graph;
  std::vector<float> inverse;  // 1 / R_i^2
  WeightSum sum;               // of the kernel
};

Input make_input(const detail::NeighborhoodGraph& graph, std::span<const float> radii,
                 Kernel kernel) {
  const simd::JoinFunctions& joins = simd::best_joins();
  Input input{graph, std::vector<float>(radii.size()),
              kernel == Kernel::wyvill ? joins.wyvill_sums : joins.wendland_sums};
  std::transform(radii.begin(), radii.end(), input.inverse.begin(),
                 [](float radius) { return std::min(1 / (radius * radius), kLargest); });
  return input;
}

// For each point i with a `changed` neighbour (empty: for all) the sum of w_ij values_j over all
// points j (no values: all 1), divided by its own value.
void sums_of(const Input& input, std::span<const float> values,
             std::span<const std::uint8_t> changed, std::vector<float>& sums) {
  input.graph.for_each_row([&](const detail::NeighborRow& row) {
    const auto is_changed = [&](std::uint32_t j) { return changed[j] != 0; };
    if (!changed.empty() && std::ranges::none_of(row.neighbors, is_changed)) return;
    simd::Row found;
    input.sum(row.join(input.graph.grid()), input.inverse.data(), values.data(), &found);
    for (std::uint32_t q = 0; q < row.count; ++q) {
      const std::uint32_t i = row.first + q;
      sums[i] = values.empty() ? found[q] : found[q] / values[i];
    }
  });
}

// Are there enough others within the smaller of both points' diameters? A point that weighs as much
// as that many others within their radii has company without a look.
bool has_company(const CellGrid& grid, std::span<const float> radii, float own_sum, std::uint32_t i,
                 std::vector<std::uint32_t>& near) {
  if (own_sum >= kFewestOthers) return true;
  near.clear();
  grid.within(grid.points()[i], 2 * radii[i], near);
  const auto others = std::ranges::count_if(near, [&](std::uint32_t j) {
    const float squared = detail::squared_distance(grid.points()[i], grid.points()[j]);
    return j != i && squared <= 4 * radii[j] * radii[j];
  });
  return static_cast<std::size_t>(others) >= kFewestOthers;
}

}  // namespace

WeightSums::WeightSums(const detail::NeighborhoodGraph& graph, std::span<const float> radii,
                       Kernel kernel)
    : own(radii.size()), around(radii.size()) {
  check(graph.grid(), radii);
  const Input input = make_input(graph, radii, kernel);
  sums_of(input, {}, {}, own);
  sums_of(input, own, {}, around);
}

void WeightSums::update(const detail::NeighborhoodGraph& graph, std::span<const float> before,
                        std::span<const float> radii, Kernel kernel) {
  check(graph.grid(), radii);
  const Input input = make_input(graph, radii, kernel);
  std::vector<std::uint8_t> changed(radii.size());
  const auto compare = [&](std::span<const float> old, std::span<const float> now) {
    for (std::size_t i = 0; i < changed.size(); ++i) {
      if (old[i] != now[i]) changed[i] = 1;
    }
  };
  compare(before, radii);
  const std::vector<float> own_before = own;
  sums_of(input, {}, changed, own);
  compare(own_before, own);
  sums_of(input, own, changed, around);
}

std::vector<float> density_weights(const WeightSums& sums) {
  // Share of Sbar_i that a sum counts at least, against large weights at borders; judgement
  // (docs/method.md 2.2).
  constexpr float kShareOfAround = 0.8f;
  std::vector<float> weights(sums.own.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 1 / std::max(sums.own[i], kShareOfAround * sums.around[i]);
  }
  return weights;
}

void weigh_by_counts(const detail::NeighborhoodGraph& graph, std::span<const std::uint32_t> counts,
                     std::span<const float> radii, std::vector<float>& weights) {
  // Factor: a lone point still holds the surface together; judgement.
  constexpr float kLeast = 0.2f;
  constexpr float kMost = 3;  // factor; judgement (docs/preparation.md, Weights)
  const auto weigh_one = [&](auto, std::uint32_t i, std::span<const std::uint32_t> near, auto) {
    float sum = 0;
    for (const std::uint32_t k : near) sum += static_cast<float>(counts[k]);
    const float mean = sum / static_cast<float>(near.size());
    if (!(mean > 0)) return;
    weights[i] *= std::clamp(static_cast<float>(counts[i]) / mean, kLeast, kMost);
  };
  detail::for_each_near(
      graph, radii, [] { return 0; }, weigh_one);
}

std::vector<std::uint8_t> radius_outliers(const CellGrid& grid, std::span<const float> radii,
                                          std::span<const float> own) {
  std::vector<std::uint8_t> mask(grid.size());
  detail::parallel_each_with<std::vector<std::uint32_t>>(
      grid.size(), 4096, [&](std::size_t k, auto& near) {
        const auto i = static_cast<std::uint32_t>(k);
        mask[i] = has_company(grid, radii, own[i], i, near) ? 0 : 1;
      });
  return mask;
}

Weights weigh(const detail::NeighborhoodGraph& graph, const Sampling& sampling, const Radii& radii,
              const WeightSums& sums, const PrepareOptions& options) {
  Weights weights{density_weights(sums), 0};
  if (!sampling.counts.empty()) {
    weigh_by_counts(graph, sampling.counts, radii.values, weights.values);
  }
  if (!options.remove_speckle || options.paper) return weights;
  auto mask = radius_outliers(sampling.grid, radii.values, sums.own);
  for (std::size_t i = 0; i < radii.outliers.size(); ++i) mask[i] |= radii.outliers[i];
  const auto outliers = static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1));
  // A whole cloud of nothing but outliers is a sparse one and keeps its weights. A part of a cloud,
  // which has facts, does consist of outliers.
  if (outliers == mask.size() && !options.facts) return weights;
  weights.outliers = outliers;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0) weights.values[i] = 0;
  }
  return weights;
}

}  // namespace palpate
