// Weighs points by how many others share their surface.

#include "prepare/weights.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/neighborhoods.hpp"
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

struct Input {
  const CellGrid& grid;
  std::vector<float> inverse;     // 1 / R_i^2
  std::vector<float> cell_reach;  // m
  WeightSum sum;                  // of the kernel
};

Input make_input(const CellGrid& grid, std::span<const float> radii, Kernel kernel) {
  const simd::JoinFunctions& joins = simd::best_joins();
  Input input{grid, std::vector<float>(grid.size()), detail::largest_in_cells(grid, radii),
              kernel == Kernel::wyvill ? joins.wyvill_sums : joins.wendland_sums};
  std::transform(radii.begin(), radii.end(), input.inverse.begin(),
                 [](float radius) { return std::min(1 / (radius * radius), kLargest); });
  return input;
}

// For each point i that is `wanted` (empty: for all) the sum of w_ij values_j over all points j;
// no values: all 1.
void sums_of(const Input& input, std::span<const float> values,
             std::span<const std::uint8_t> wanted, std::vector<float>& sums) {
  const auto is_wanted = [&](std::uint32_t begin, std::uint32_t count) {
    return wanted.empty() || std::ranges::count(wanted.subspan(begin, count), 1) > 0;
  };
  detail::for_each_block(input.grid, [&](const detail::Block& block, detail::Surroundings& around) {
    if (!is_wanted(block.begin, block.size())) return;
    detail::for_each_part(
        input.grid, {.of_points = {}, .times = 1, .of_cells = input.cell_reach}, block, around,
        [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
          if (!is_wanted(first, count)) return;
          simd::Row row;
          input.sum(detail::make_join(input.grid, first, count, runs), input.inverse.data(),
                    values.data(), &row);
          for (std::uint32_t q = 0; q < count; ++q) {
            if (is_wanted(first + q, 1)) sums[first + q] = row[q];
          }
        });
  });
}

// For each point i that is `wanted` the mean of its surroundings: sum of w_ij own_j over own_i.
void means_of(const Input& input, std::span<const float> own, std::span<const std::uint8_t> wanted,
              std::vector<float>& means) {
  sums_of(input, own, wanted, means);
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (wanted.empty() || wanted[i] != 0) means[i] /= own[i];
  }
}

// 1 for each point of leaves into which any point reaches. `reaches`: of the points, m; 0: not at
// all.
std::vector<std::uint8_t> reached(const CellGrid& grid, const std::vector<float>& reaches) {
  std::vector<std::uint8_t> result(grid.size());
  const std::vector<float> of_cells = detail::largest_in_cells(grid, reaches);
  std::array<std::uint32_t, CellGrid::kMaxStack> stack;
  for (std::size_t c = 0; c < of_cells.size(); ++c) {
    const CellGrid::Cell& from = grid.cells()[c];
    if (of_cells[c] <= 0 || from.children > 0) continue;
    std::size_t open = 0;
    stack[open++] = 0;
    while (open > 0) {
      const CellGrid::Cell& cell = grid.cells()[stack[--open]];
      const float squared = detail::squared_distance(cell, from.lower, from.upper);
      if (squared > of_cells[c] * of_cells[c]) continue;
      for (std::uint32_t k = 0; k < cell.children; ++k) stack[open++] = cell.first_child + k;
      if (cell.children == 0) std::fill_n(result.begin() + cell.begin, cell.size(), 1);
    }
  }
  return result;
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

WeightSums::WeightSums(const CellGrid& grid, std::span<const float> radii, Kernel kernel)
    : own(grid.size()), around(grid.size()) {
  check(grid, radii);
  const Input input = make_input(grid, radii, kernel);
  sums_of(input, {}, {}, own);
  means_of(input, own, {}, around);
}

void WeightSums::update(const CellGrid& grid, std::span<const float> before,
                        std::span<const float> radii, Kernel kernel) {
  check(grid, radii);
  const Input input = make_input(grid, radii, kernel);
  std::vector<float> reaches(grid.size());  // of points that are not as before, m
  const auto look = [&](std::span<const float> old, std::span<const float> now) {
    for (std::size_t i = 0; i < reaches.size(); ++i) {
      if (old[i] != now[i]) reaches[i] = std::max(before[i], radii[i]);
    }
  };
  look(before, radii);
  const std::vector<float> own_before = own;
  sums_of(input, {}, reached(grid, reaches), own);
  look(own_before, own);
  means_of(input, own, reached(grid, reaches), around);
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

void weigh_by_counts(const CellGrid& grid, std::span<const std::uint32_t> counts,
                     std::span<const float> radii, std::vector<float>& weights) {
  // Factor: a lone point still holds the surface together; judgement.
  constexpr float kLeast = 0.2f;
  constexpr float kMost = 3;  // factor; judgement (docs/preparation.md, Weights)
  detail::parallel_each_with<std::vector<std::uint32_t>>(
      weights.size(), 1024, [&](std::size_t i, auto& near) {
        near.clear();
        grid.within(grid.points()[i], radii[i], near);
        float sum = 0;
        for (const std::uint32_t k : near) sum += static_cast<float>(counts[k]);
        const float mean = near.empty() ? 0 : sum / static_cast<float>(near.size());
        if (!(mean > 0)) return;
        weights[i] *= std::clamp(static_cast<float>(counts[i]) / mean, kLeast, kMost);
      });
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

Weights weigh(const Sampling& sampling, const Radii& radii, const WeightSums& sums,
              const PrepareOptions& options) {
  Weights weights{density_weights(sums), 0};
  if (!sampling.counts.empty()) {
    weigh_by_counts(sampling.grid, sampling.counts, radii.values, weights.values);
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
