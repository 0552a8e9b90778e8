#include "prepare/radii.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/normals.hpp"
#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/sheet_fit.hpp"

namespace palpate {

namespace {

constexpr std::size_t kSpacingSamples = 1000;
constexpr std::size_t kFewestPoints = 100;  // points that tell
constexpr std::size_t kLooked = 9;          // itself, and others of which some may share its place

// Random points have 0.52; scanners' meshes, frames and jittered grids 0.71 and above.
constexpr double kIrregular = 0.65;

}  // namespace

double nearest_share(const CellGrid& grid, std::span<const float> spacings) {
  if (grid.size() < kFewestPoints) return 1;
  const std::size_t step = std::max<std::size_t>(1, grid.size() / kSpacingSamples);
  std::vector<float> shares;
  std::vector<CellGrid::Neighbor> near;
  for (std::size_t i = step / 2; i < grid.size(); i += step) {
    grid.nearest(grid.points()[i], kLooked, near);
    const auto other =
        std::ranges::find_if(near, [](const auto& found) { return found.squared_distance > 0; });
    if (other != near.end()) shares.push_back(std::sqrt(other->squared_distance) / spacings[i]);
  }
  return shares.empty() ? 1 : median(shares);
}

bool is_irregular(const CellGrid& grid, std::span<const float> spacings) {
  return nearest_share(grid, spacings) < kIrregular;
}

namespace {

constexpr std::size_t kRawPerSample = 32;
constexpr std::size_t kMostSamples = 20000;
constexpr float kWindow = 5;         // spacings
constexpr float kSurroundings = 20;  // spacings
constexpr double kFlatter = 0.3;     // the quantile that is taken
constexpr std::size_t kFewest = 8;   // samples that a quantile is taken of

}  // namespace

NoiseMap::NoiseMap(const CellGrid& raw, std::span<const float> spacings) {
  const std::size_t step = std::max(kRawPerSample, raw.size() / kMostSamples);
  const std::size_t count = raw.size() / step;
  std::vector<float> found(count);
  detail::parallel_ranges(count, 64, [&](std::size_t begin, std::size_t end) {
    SheetFitter fitter;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = k * step + step / 2;
      const SheetFit fit =
          fitter.fit(raw, raw.points()[i], static_cast<double>(kWindow * spacings[i]),
                     static_cast<double>(spacings[i]));
      found[k] = static_cast<float>(fit.bend * fit.footprint);
    }
  });
  std::vector<Eigen::Vector3f> places;
  std::vector<float> values;
  for (std::size_t k = 0; k < count; ++k) {
    if (!(found[k] > 0)) continue;
    places.push_back(raw.points()[k * step + step / 2]);
    values.push_back(found[k]);
  }
  reach_ = kSurroundings * static_cast<float>(median(spacings));
  places_ = CellGrid(places);
  for (const std::uint32_t k : places_.order()) values_.push_back(values[k]);
  typical_ = static_cast<float>(median(values_));
}

std::vector<float> NoiseMap::at(std::span<const Eigen::Vector3f> points) const {
  std::vector<float> all(points.size(), typical_);
  detail::parallel_ranges(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    std::vector<float> around;
    for (std::size_t i = begin; i < end; ++i) {
      near.clear();
      around.clear();
      places_.within(points[i], reach_, near);
      if (near.size() < kFewest) continue;
      for (const std::uint32_t k : near) around.push_back(values_[k]);
      const auto place = around.begin() + static_cast<std::ptrdiff_t>(
                                              kFlatter * static_cast<double>(around.size() - 1));
      std::nth_element(around.begin(), place, around.end());
      all[i] = *place;
    }
  });
  return all;
}

namespace {

// Noise tilts normals by 3.2 sigma_n delta / R^2 (docs/method.md 5.3).
constexpr double kNoiseToTilt = 3.2;

// No R is above this many floors (2.5 spacings each): more smoothing would cost shape and time, and
// noise that needs it is the sensor's to filter.
constexpr float kMostFloors = 2.4f;

// Rms distance from the plane, in R. Noise gives theta R / (3.2 s), about 0.03; a sphere of four R
// 0.04; a right angle 0.2.
constexpr float kBends = 0.08f;
constexpr float kEdge = 0.14f;
constexpr float kShrink = 0.25f;
constexpr float kSmoothing = 0.5f;  // R within which radii are averaged

}  // namespace

std::vector<float> noisy_radii(const CellGrid& grid, const NoiseMap& noise, double excess,
                               double normal_error, const std::vector<float>& floors) {
  const double scale = kNoiseToTilt * excess / normal_error;
  std::vector<float> radii = noise.at(grid.points());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double radius = std::sqrt(scale * static_cast<double>(radii[i]));
    radii[i] = std::clamp(static_cast<float>(radius), floors[i], kMostFloors * floors[i]);
  }
  shrink_at_edges(grid, floors, radii);
  return radii;
}

void shrink_at_edges(const CellGrid& grid, const std::vector<float>& floors,
                     std::vector<float>& radii) {
  const std::vector<float> residuals = estimate_normals(grid, radii).residuals;
  std::vector<float> small(radii.size());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const float bend = (residuals[i] / radii[i] - kBends) / (kEdge - kBends);
    small[i] = std::max(floors[i], radii[i] * (1 - kShrink * std::clamp(bend, 0.0f, 1.0f)));
  }
  // Averaged, so that noise in the residuals does not make R flicker from point to point.
  detail::parallel_ranges(radii.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      near.clear();
      grid.within(grid.points()[i], kSmoothing * radii[i], near);
      float sum = 0;
      for (const std::uint32_t k : near) sum += small[k];
      if (!near.empty()) radii[i] = std::max(floors[i], sum / static_cast<float>(near.size()));
    }
  });
}

std::vector<float> density_weights(const CellGrid& grid, std::span<const float> radii,
                                   Kernel kernel) {
  return density_weights(weight_sums(grid, radii, kernel));
}

detail::WeightSums weight_sums(const CellGrid& grid, std::span<const float> radii, Kernel kernel) {
  const simd::JoinFunctions& joins = simd::best_joins();
  return detail::weight_sums(grid, radii,
                             kernel == Kernel::wyvill ? joins.wyvill_sums : joins.wendland_sums);
}

std::vector<float> density_weights(const detail::WeightSums& sums) {
  constexpr float kShareOfAround = 0.8f;
  std::vector<float> weights(sums.own.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 1 / std::max(sums.own[i], kShareOfAround * sums.around[i]);
  }
  return weights;
}

}  // namespace palpate
