#include "palpate/geometry/spacing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/neighborhoods.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using detail::Group;
using detail::JoinSpace;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr std::size_t kNearest = 8;           // others that a spacing is measured from
constexpr float kSmoothing = 2.5f;            // spacings that it is averaged over
constexpr float kMaxGrowth = 1.5f;            // of a spacing by averaging
constexpr float kMaxRatio = 2;                // to the spacing around it
constexpr float kMaxScale = 1e9f;             // of spacings in one neighbourhood
constexpr std::size_t kMaxCandidates = 4096;  // more mean that a stray point looks at a surface

using Nearest = void (*)(const simd::Coordinates&, const simd::Coordinates&, float* const*);

// A first guess of the spacing in a group, from its extent.
float guess_spacing(const Group& group) {
  const Eigen::Vector3f extent = group.upper - group.lower;
  const float longest = extent.maxCoeff();
  const float middle = extent.sum() - longest - extent.minCoeff();
  const auto count = static_cast<float>(group.size());
  return std::max(std::sqrt(longest * middle / count), longest / count);
}

// Hands out the queries whose nearest are certain; the others, whose last slot may belong to a
// point outside the radius, stay as queries.
template <class Result>
void settle(const CellGrid& grid, std::size_t slots, float squared_radius, JoinSpace& space,
            const Result& result) {
  std::array<std::uint32_t, detail::kGroupPoints> open;
  std::size_t count = 0;
  const std::span<const std::uint32_t> asked = space.queries.indices();
  for (std::size_t q = 0; q < asked.size(); ++q) {
    if (q > 0 && asked[q] == asked[q - 1]) break;  // padding
    if (space.results[slots - 1][q] <= squared_radius) {
      result(asked[q], q);
    } else {
      open[count++] = asked[q];
    }
  }
  space.queries.clear();
  for (std::size_t k = 0; k < count; ++k) space.queries.push_back(open[k], grid.points()[open[k]]);
  if (count > 0) space.queries.pad();
}

// Finds the `slots` nearest of each point of the group and calls result(point, query) with their
// squared distances in space.results[0 ... slots - 1][query].
template <class Result>
void find_nearest(const CellGrid& grid, const Group& group, Nearest nearest, std::size_t slots,
                  JoinSpace& space, const Result& result) {
  const float extent = (grid.cells()[0].upper - grid.cells()[0].lower).maxCoeff();
  float radius = guess_spacing(group) * std::sqrt(static_cast<float>(slots));
  space.ask_for(grid, group);
  while (space.queries.size() > 0) {
    detail::gather(grid, group, radius, space.candidates);
    nearest(space.queries.coordinates(), space.candidates.coordinates(), space.rows.data());
    const bool all = space.candidates.size() == grid.size();
    settle(grid, slots, all ? kInfinity : radius * radius, space, result);
    radius = std::max(1.6f * radius, 1e-6f * extent);
  }
}

// The mean distance of each point to its three nearest others.
std::vector<float> mean_distances_to_three(const CellGrid& grid) {
  std::vector<float> means(grid.size());
  const auto others = static_cast<float>(std::min<std::size_t>(3, grid.size() - 1));
  detail::for_each_group(grid, [&](const Group& group, JoinSpace& space) {
    find_nearest(grid, group, simd::best_joins().nearest4, 4, space,
                 [&](std::uint32_t point, std::size_t query) {
                   float sum = 0;  // slot 0 is the point itself, or another at its place
                   for (std::size_t k = 1; k < 4; ++k) {
                     const float d = space.results[k][query];
                     if (d < kInfinity) sum += std::sqrt(d);
                   }
                   means[point] = sum / others;
                 });
  });
  return means;
}

std::vector<float> mean_distances(const CellGrid& grid, std::size_t k) {
  std::vector<float> means(grid.size());
  detail::parallel_ranges(grid.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<CellGrid::Neighbor> found;
    for (std::size_t i = begin; i < end; ++i) {
      grid.nearest(grid.points()[i], k + 1, found);
      float sum = 0;
      for (const CellGrid::Neighbor& neighbor : found) sum += std::sqrt(neighbor.squared_distance);
      means[i] = sum / static_cast<float>(found.size() - 1);
    }
  });
  return means;
}

// On a uniform plane the mean of k r^2's is (k + 1) / (2 pi) of the area per point; the factor
// makes a square grid exact (its eight nearest: four at s, four at sqrt(2) s).
float spacing_from(const JoinSpace& space, std::size_t query) {
  float sum = 0;
  float count = 0;
  for (std::size_t k = 0; k < kNearest; ++k) {
    if (!(space.results[k][query] < kInfinity)) break;
    sum += space.results[k][query];
    ++count;
  }
  return count > 0 ? std::sqrt(6 * sum / (count * (count + 1))) : 0;
}

std::vector<float> raw_spacings(const CellGrid& grid) {
  std::vector<float> spacings(grid.size());
  detail::for_each_group(grid, [&](const Group& group, JoinSpace& space) {
    find_nearest(grid, group, simd::best_joins().nearest8_apart, kNearest, space,
                 [&](std::uint32_t point, std::size_t query) {
                   const float s = spacing_from(space, query);
                   spacings[point] = s > 0 ? s : static_cast<float>(kLoneSpacing);
                 });
  });
  return spacings;
}

// own: the point's spacing; area and volume: sums of w s^2 and w s^3 over its neighbours.
float smoothed(float own, float area, float volume) {
  if (!(area > 0)) return own;
  const float among_others = volume / area;
  const float mean = (volume + own * own * own) / (area + own * own);
  return std::min({mean, kMaxGrowth * own, kMaxRatio * among_others});
}

// For a group whose neighbourhoods hold too many points: each point with its nearest alone.
void smooth_one_by_one(const CellGrid& grid, const Group& group, std::span<const float> spacings,
                       std::span<float> result) {
  std::vector<CellGrid::Neighbor> found;
  for (std::uint32_t i = group.begin; i < group.end; ++i) {
    grid.nearest(grid.points()[i], kNearest + 1, found);
    float area = 0;
    float volume = 0;
    for (const CellGrid::Neighbor& neighbor : found) {
      if (neighbor.squared_distance == 0) continue;
      const float s = std::min(spacings[neighbor.index] / spacings[i], kMaxScale);
      area += s * s;
      volume += s * s * s;
    }
    result[i] = spacings[i] * smoothed(1, area, volume);
  }
}

void smooth_group(const CellGrid& grid, const Group& group, std::span<const float> spacings,
                  JoinSpace& space, std::span<float> result) {
  const auto own = spacings.subspan(group.begin, group.size());
  const auto [smallest, largest] = std::minmax_element(own.begin(), own.end());
  if (!detail::gather(grid, group, kSmoothing * *largest, space.candidates, kMaxCandidates)) {
    smooth_one_by_one(grid, group, spacings, result);
    return;
  }
  const float scale = *smallest;  // keeps cubes within float's range
  space.ask_for(grid, group);
  space.query_values.clear();
  for (const std::uint32_t i : space.queries.indices()) {
    const float reach = kSmoothing * spacings[i];
    space.query_values.push_back(std::min(1 / (reach * reach), kLargest));
  }
  for (auto& column : space.values) column.clear();
  for (const std::uint32_t i : space.candidates.indices()) {
    const float s = std::min(spacings[i] / scale, kMaxScale);
    space.values[0].push_back(s * s);
    space.values[1].push_back(s * s * s);
  }
  const std::array<const float*, 2> columns{space.values[0].data(), space.values[1].data()};
  simd::best_joins().wyvill_means(space.queries.coordinates(), space.query_values.data(),
                                  space.candidates.coordinates(), columns.data(),
                                  space.rows.data());
  for (std::uint32_t q = 0; q < group.size(); ++q) {
    result[group.begin + q] = scale * smoothed(std::min(own[q] / scale, kMaxScale),
                                               space.results[0][q], space.results[1][q]);
  }
}

}  // namespace

double mean_spacing(const CellGrid& grid, int k) {
  if (k < 1) throw Error(fmt::format("spacing: k = {} neighbours; it takes one or more", k));
  if (grid.size() < 2) return kLoneSpacing;
  const std::vector<float> means =
      k == 3 ? mean_distances_to_three(grid) : mean_distances(grid, static_cast<std::size_t>(k));
  double sum = 0;
  for (const float mean : means) sum += static_cast<double>(mean);
  return sum > 0 ? sum / static_cast<double>(means.size()) : kLoneSpacing;
}

std::vector<float> local_spacings(const CellGrid& grid) {
  const std::vector<float> raw = raw_spacings(grid);
  std::vector<float> spacings(raw.size());
  detail::for_each_group(grid, [&](const Group& group, JoinSpace& space) {
    smooth_group(grid, group, raw, space, spacings);
  });
  return spacings;
}

double median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace palpate
