// Measures the distances between neighbouring points of a cloud.
#include "palpate/geometry/spacing.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/neighborhood_graph.hpp"

namespace palpate {
namespace {

constexpr std::size_t kMany = std::size_t{1} << 17;    // values; from here on select() (judgement)
constexpr std::size_t kDigits = std::size_t{1} << 16;  // values of half a float's bits

// Integers in the order of the numbers.
std::uint32_t rank_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

float value_of(std::uint32_t rank) {
  return std::bit_cast<float>((rank & 0x80000000u) != 0 ? rank ^ 0x80000000u : ~rank);
}

// The digit in which entry `index` falls; `index` becomes its index within that digit.
std::uint32_t digit_at(const std::vector<std::uint32_t>& counts, std::size_t& index) {
  std::uint32_t digit = 0;
  for (; index >= counts[digit]; ++digit) index -= counts[digit];
  return digit;
}

// Counts upper, then lower halves of ranks: no copy, and memory is read in order.
float select(std::span<const float> values, std::size_t index) {
  std::vector<std::uint32_t> counts(kDigits, 0);
  for (const float value : values) ++counts[rank_of(value) >> 16];
  const std::uint32_t upper = digit_at(counts, index);
  std::fill(counts.begin(), counts.end(), 0u);
  for (const float value : values) {
    const std::uint32_t rank = rank_of(value);
    if (rank >> 16 == upper) ++counts[rank & (kDigits - 1)];
  }
  return value_of(upper << 16 | digit_at(counts, index));
}

}  // namespace

double median(std::span<const float> values) {
  if (values.empty()) return 0;
  const std::size_t middle = values.size() / 2;
  if (values.size() >= kMany) return static_cast<double>(select(values, middle));
  std::vector<float> sorted(values.begin(), values.end());
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(middle);
  std::nth_element(sorted.begin(), at, sorted.end());
  return static_cast<double>(*at);
}

namespace {

using detail::Block;
using detail::Surroundings;

constexpr float kInfinity = std::numeric_limits<float>::infinity();  // m^2: no such neighbour
constexpr float kLargestFloat = std::numeric_limits<float>::max();   // 1/m^2, for radii of 0
// Other points that a spacing is measured from (docs/method.md 5.1)
constexpr std::size_t kNearest = 8;
constexpr float kSmoothing = 2.5f;   // spacings that it is averaged over (docs/method.md 5.1)
constexpr float kMinChange = 0.75f;  // of a spacing by averaging, at least (docs/method.md 5.1)
constexpr float kMaxChange = 1.5f;   // of a spacing by averaging, at most (docs/method.md 5.1)
constexpr float kMaxRatio = 2;       // to the spacing around it (docs/method.md 5.1)
constexpr float kLargestSpacing = 1e18f;  // m; its sums stay in float's range (derived)
constexpr float kOutlier = 8;             // times its block's spacing: an outlier (judgement)
// Share of the distance to the nearest other, if fewer than eight give no area: R, which is 2.5
// spacings, is then half of that distance (derived).
constexpr float kGapShare = 0.2f;

using Nearest = void (*)(const simd::Join&, simd::Row*);

// A first guess of the spacing in a block, from its extent.
float guess_spacing(const Block& block) {
  const Eigen::Vector3f extent = block.upper - block.lower;
  const float longest = extent.maxCoeff();
  const float middle = std::max(0.F, extent.sum() - longest - extent.minCoeff());  // it rounds
  const auto count = static_cast<float>(block.size());
  return std::max(std::sqrt(longest * middle / count), longest / count);
}

// For every point its kSlots nearest: calls result(point, query, rows) with their squared distances
// in rows[0 ... kSlots - 1][query].
template <std::size_t kSlots, class Result>
void find_nearest(const CellGrid& grid, Nearest nearest, const Result& result) {
  const float extent = (grid.cells()[0].upper - grid.cells()[0].lower).maxCoeff();
  const std::vector<Block> blocks = detail::make_blocks(grid, detail::kBlockPoints);
  detail::parallel_each_with<Surroundings>(
      blocks.size(), 8, [&](std::size_t b, auto& surroundings) {
        const Block& block = blocks[b];
        const float start = std::sqrt(static_cast<float>(kSlots)) * guess_spacing(block);
        float around = start;
        surroundings.find(grid, block, around);
        for (std::uint32_t first = block.begin; first < block.end; first += simd::kQueries) {
          const Block part = detail::make_block(
              grid, first, std::min<std::uint32_t>(first + simd::kQueries, block.end));
          simd::Row rows[kSlots];
          for (float radius = start;; radius = std::max(1.6f * radius, 1e-6f * extent)) {
            if (radius > around) surroundings.find(grid, block, around = radius);
            const detail::NeighborRow row = surroundings.row(part, radius);
            nearest(row.join(grid), rows);
            // All closer than any point that was not looked at?
            const float* last = rows[kSlots - 1];
            if (*std::max_element(last, last + part.size()) <= radius * radius) break;
            if (row.neighbors.size() == grid.size()) break;
          }
          for (std::uint32_t q = 0; q < part.size(); ++q) result(first + q, q, rows);
        }
      });
}

// The mean distance of each point to its three nearest others.
std::vector<float> mean_distances_to_three(const CellGrid& grid) {
  std::vector<float> means(grid.size());
  const auto others = static_cast<float>(std::min<std::size_t>(3, grid.size() - 1));
  find_nearest<4>(grid, simd::best_joins().nearest4,
                  [&](std::uint32_t point, std::uint32_t query, const simd::Row* rows) {
                    float sum = 0;  // row 0 is the point itself, or another at its position
                    for (std::size_t k = 1; k < 4; ++k) {
                      if (rows[k][query] < kInfinity) sum += std::sqrt(rows[k][query]);
                    }
                    means[point] = sum / others;
                  });
  return means;
}

// On a uniform plane the mean of k r^2's is (k + 1) / (2 pi) of the area per point; the factor
// makes a square grid exact (its eight nearest: four at s, four at sqrt(2) s).
float spacing_from(const simd::Row* rows, std::uint32_t query) {
  float sum = 0;
  float count = 0;
  for (std::size_t k = 0; k < kNearest; ++k) {
    if (!(rows[k][query] < kInfinity)) break;
    sum += rows[k][query];
    ++count;
  }
  if (count == 0) return 0;
  if (count < kNearest) return kGapShare * std::sqrt(rows[0][query]);
  return std::sqrt(6 * sum / (count * (count + 1)));
}

std::vector<float> raw_spacings(const CellGrid& grid) {
  std::vector<float> spacings(grid.size());
  find_nearest<kNearest>(grid, simd::best_joins().nearest8_apart,
                         [&](std::uint32_t point, std::uint32_t query, const simd::Row* rows) {
                           const float s = spacing_from(rows, query);
                           spacings[point] = s > 0 ? s : static_cast<float>(kLoneSpacing);
                         });
  return spacings;
}

// own: the point's spacing; weight, sum: of w and w s over its neighbours.
float smoothed(float own, float weight, float sum) {
  if (!(weight > 0)) return own;
  const float mean = (sum + own) / (weight + 1);
  return std::min(std::clamp(mean, kMinChange * own, kMaxChange * own), kMaxRatio * sum / weight);
}

// Averages a point's spacing over its nearest others alone.
float smoothed_alone(const CellGrid& grid, std::span<const float> spacings, std::uint32_t i) {
  std::vector<CellGrid::Neighbor> found;
  grid.nearest(grid.points()[i], kNearest + 1, found);
  float weight = 0;
  float sum = 0;
  for (const CellGrid::Neighbor& neighbor : found) {
    if (neighbor.squared_distance == 0) continue;
    ++weight;
    sum += spacings[neighbor.index];
  }
  return smoothed(spacings[i], weight, sum);
}

// Within how much of its surroundings each point is averaged, m; 0 for outliers, whose surroundings
// at their scale may hold a whole surface.
std::vector<float> smoothing_radii(const CellGrid& grid, std::span<const float> spacings) {
  std::vector<float> radii(grid.size());
  const std::vector<Block> blocks = detail::make_blocks(grid, detail::kBlockPoints);
  detail::parallel_each(blocks.size(), 8, [&](std::size_t b) {
    const Block& block = blocks[b];
    const auto own = spacings.subspan(block.begin, block.size());
    const auto outlier = kOutlier * static_cast<float>(median(own));
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      radii[i] = spacings[i] > outlier ? 0 : kSmoothing * spacings[i];
    }
  });
  return radii;
}

std::vector<float> smooth(const CellGrid& grid, std::vector<float> spacings) {
  const std::vector<float> radii = smoothing_radii(grid, spacings);
  for (float& s : spacings) s = std::min(s, kLargestSpacing);
  std::vector<float> result(grid.size());
  detail::NeighborhoodGraph(grid, radii).for_each_row([&](const detail::NeighborRow& row) {
    simd::Row inverse = {};
    for (std::uint32_t q = 0; q < row.count; ++q) {
      const float radius = radii[row.first + q];
      inverse[q] = radius > 0 ? std::min(1 / (radius * radius), kLargestFloat) : kLargestFloat;
    }
    simd::Row sums[2];
    simd::best_joins().wyvill_means(row.join(grid), inverse, spacings.data(), sums);
    for (std::uint32_t q = 0; q < row.count; ++q) {
      const std::uint32_t i = row.first + q;
      result[i] = radii[i] > 0 ? smoothed(spacings[i], sums[0][q], sums[1][q])
                               : smoothed_alone(grid, spacings, i);
    }
  });
  return result;
}

}  // namespace

double mean_spacing(const CellGrid& grid) {
  if (grid.size() < 2) return kLoneSpacing;
  const std::vector<float> means = mean_distances_to_three(grid);
  double sum = 0;
  for (const float mean : means) sum += static_cast<double>(mean);
  return sum > 0 ? sum / static_cast<double>(means.size()) : kLoneSpacing;
}

std::vector<float> local_spacings(const CellGrid& grid) {
  if (grid.size() == 0) return {};
  return smooth(grid, raw_spacings(grid));
}

}  // namespace palpate
