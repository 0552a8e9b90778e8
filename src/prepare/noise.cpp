// Measures noise in windows of several widths, and maps it.

#include "prepare/noise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/segment_fit.hpp"

namespace palpate {
namespace {

constexpr std::size_t kSamples = 1000;  // windows, about; judgement

/// A window that noise is measured in. Two widths are compared, of about 28 and 15 points: noise
/// leaves the same residual in both; shape that a quadric misses, as a thin rod's, leaves 0.4 of it
/// or less in the narrower one.
struct Window {
  double reach;              // spacings
  std::size_t fewest;        // points
  double quarter_to_median;  // of the residuals that noise alone gives
};
// Ratios are derived: the median over the lower quartile of the rms of n - 6 normal residuals.
constexpr Window kNarrow{3, 12, 1.1};       // n = 28
constexpr Window kNarrowest{2.2, 10, 1.2};  // n = 15
constexpr double kShape = 0.65;  // of the wider window's noise: the rest is shape; judgement

// A ball full of points has a residual of 0.3 to 0.45 of its reach, and a layer whose sigma is a
// quarter of the reach 0.23 (computed: uniform and normal heights, less the quadric). Where a
// residual is larger it measures the window's size and not the noise, so a window twice as wide is
// fitted.
constexpr double kFilled = 1 / kSigmasInReach;
constexpr double kWidestReach = 24;  // spacings; more is left to the sensor's filter; judgement
// Share of the widest reach. A ball full of points leaves 0.45, a layer whose sigma is 0.45 of the
// reach 0.34 (computed).
constexpr double kVolume = 0.35;

// Windows, in spacings, that separate noise from shape: shape that a quadratic misses grows with
// the third power of the window or faster.
constexpr std::size_t kWideSamples = 400;  // windows, about; judgement
constexpr double kMapReach = 5;            // spacings, of the map of noise as well; judgement
constexpr double kMiddleReach = 10;        // spacings; twice that
constexpr double kWideReach = 20;          // spacings; twice that
constexpr double kTile = 4;           // spacings: sides of tiles, of about 16 points; judgement
constexpr double kFlattest = 0.25;    // share of the windows that are believed; judgement
constexpr double kShapeGrowth = 1.5;  // from the middle to the wide window: shape; judgement
constexpr double kFlatNoise = 0.02;   // spacings: less noise is not looked at; judgement
constexpr double kNoteworthy = 1.2;   // excess that is not ignored; judgement
// Ratio of sigmas: more is shape, not neighbours that err together; judgement.
constexpr double kMostRise = 5;

std::size_t step_for(const CellGrid& grid, std::size_t samples) {
  return std::max<std::size_t>(1, grid.size() / samples);
}

/// Does a residual fill a window, both in m?
bool fills(double residual, double reach) {
  return residual > kFilled * reach;
}

/// The fit at a position: `first`, whose window reaches `reach`, or one of a window so much wider
/// that noise does not fill it. In a volume no window finds a layer: then it is `first`.
SegmentFit fit_beyond_noise(SegmentFitter& fitter, const CellGrid& grid, const Eigen::Vector3f& at,
                            double reach, double spacing, const SegmentFit& first) {
  SegmentFit fit = first;
  while (fills(fit.quadric_residual, reach) && 2 * reach <= kWidestReach * spacing) {
    reach *= 2;
    fit = fitter.fit(grid, at, reach, spacing);
  }
  return fit.quadric_residual > kVolume * reach ? first : fit;
}

/// The fits around one sampled point.
struct Row {
  Eigen::Vector3f at;
  double spacing = 0;  // m
  SegmentFit narrow;
  SegmentFit narrowest;
};

std::vector<Row> fit_windows(const CellGrid& grid, std::span<const float> spacings) {
  const std::size_t step = step_for(grid, kSamples);
  std::vector<Row> rows((grid.size() - step / 2 + step - 1) / step);
  detail::parallel_each_with<SegmentFitter>(rows.size(), 64, [&](std::size_t k, auto& fitter) {
    const std::size_t i = k * step + step / 2;
    const Eigen::Vector3f& at = grid.points()[i];
    const auto spacing = static_cast<double>(spacings[i]);
    rows[k] = {at, spacing, fitter.fit(grid, at, kNarrow.reach * spacing, spacing),
               fitter.fit(grid, at, kNarrowest.reach * spacing, spacing)};
  });
  return rows;
}

/// The noise by rows, as the flatter quarter has it: where shape is finer than the window it passes
/// for noise. 0 where no row has enough points.
double noise_in(const std::vector<Row>& rows, SegmentFit Row::*fit, const Window& window) {
  std::vector<float> residuals;
  for (const Row& row : rows) {
    if ((row.*fit).points >= window.fewest) {
      residuals.push_back(static_cast<float>((row.*fit).quadric_residual));
    }
  }
  if (residuals.empty()) return 0;
  const auto quarter = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 4);
  std::nth_element(residuals.begin(), quarter, residuals.end());
  return window.quarter_to_median * *quarter;
}

/// The noise in narrow windows, m; those that noise fills are widened.
double narrow_noise(const CellGrid& grid, std::span<const float> spacings) {
  std::vector<Row> rows = fit_windows(grid, spacings);
  const double narrow = noise_in(rows, &Row::narrow, kNarrow);
  const double narrowest = noise_in(rows, &Row::narrowest, kNarrowest);
  if (narrowest > 0 && narrowest < kShape * narrow) return narrowest;
  if (!fills(narrow, kNarrow.reach * median(spacings))) return narrow;
  detail::parallel_each_with<SegmentFitter>(rows.size(), 64, [&](std::size_t k, auto& fitter) {
    Row& row = rows[k];
    row.narrow = fit_beyond_noise(fitter, grid, row.at, kNarrow.reach * row.spacing, row.spacing,
                                  row.narrow);
  });
  return noise_in(rows, &Row::narrow, kNarrow);
}

/// Residuals of windows of several widths around one position, compared.
struct Widths {
  float growth = 0;  // of sigma, from the middle to the wide window
  float rise = 0;    // of sigma, from the narrowest to the wide window
  float sigma = 0;   // in the wide window, m
  float excess = 0;
};

std::vector<Widths> compare_widths(const CellGrid& grid, double spacing) {
  const std::size_t step = step_for(grid, kWideSamples);
  std::vector<Widths> all((grid.size() + step - 1) / step);
  detail::parallel_each_with<SegmentFitter>(all.size(), 16, [&](std::size_t k, auto& fitter) {
    const Eigen::Vector3f& at = grid.points()[std::min(k * step + step / 2, grid.size() - 1)];
    const SegmentFit narrow = fitter.fit(grid, at, kNarrow.reach * spacing, spacing);
    const SegmentFit map = fitter.fit(grid, at, kMapReach * spacing, 0);
    const SegmentFit middle = fitter.fit(grid, at, kMiddleReach * spacing, 0);
    if (!(narrow.quadric_residual > 0 && map.quadric_residual > 0 && middle.quadric_residual > 0))
      return;
    const SegmentFit wide = fitter.fit(grid, at, kWideReach * spacing, 0);
    double together = wide.quadric_residual;  // used only where the wide window holds no shape
    if (wide.quadric_residual <= kShapeGrowth * middle.quadric_residual) {
      const double tiles = fitter.tile_variance(kWideReach * spacing, kTile * spacing);
      together = std::max(together, std::sqrt(tiles));
    }
    all[k] = {static_cast<float>(wide.quadric_residual / middle.quadric_residual),
              static_cast<float>(wide.quadric_residual / narrow.quadric_residual),
              static_cast<float>(wide.quadric_residual),
              static_cast<float>(together / map.quadric_residual)};
  });
  std::erase_if(all, [](const Widths& w) { return w.growth == 0; });
  return all;
}

template <class Item>
double median_of(const std::vector<Item>& all, float Item::*value) {
  std::vector<float> values;
  for (const Item& item : all) values.push_back(item.*value);
  return median(values);
}

}  // namespace

Noise measure_noise(const CellGrid& grid, double spacing, std::span<const float> spacings) {
  Noise noise{.sigma = narrow_noise(grid, spacings)};
  if (noise.sigma < kFlatNoise * spacing) return noise;
  std::vector<Widths> all = compare_widths(grid, spacing);
  std::stable_sort(all.begin(), all.end(),
                   [](const Widths& a, const Widths& b) { return a.growth < b.growth; });
  all.resize(static_cast<std::size_t>(kFlattest * static_cast<double>(all.size())));
  if (all.empty() || all.back().growth > kShapeGrowth) return noise;
  const double excess = median_of(all, &Widths::excess);
  if (excess < kNoteworthy) return noise;
  const double rise = median_of(all, &Widths::rise);
  if (rise > kMostRise) return noise;  // shape that is as wavy in all wide windows
  noise.excess = excess;
  const double sigma = median_of(all, &Widths::sigma);
  // Where noise fills narrow windows, the map's wider ones see all of it.
  const bool filled = fills(noise.sigma, kNarrow.reach * spacing);
  noise.shared = filled ? 1 : std::max(1., sigma / noise.sigma);
  noise.sigma = std::max(noise.sigma, sigma);
  return noise;
}

namespace {

constexpr std::size_t kRawPerSample = 32;  // points for one window of the map; judgement
// Windows of the map, about, to bound its time; judgement.
constexpr std::size_t kMostSamples = 20000;
constexpr float kSurroundings = 20;  // spacings; judgement
// The quantile that is taken, so that edges are no noise; judgement.
constexpr double kFlatter = 0.3;
constexpr std::size_t kFewest = 8;  // samples that a quantile is taken of; judgement

}  // namespace

NoiseMap::NoiseMap(const CellGrid& raw, std::span<const float> spacings) {
  const std::size_t step = std::max(kRawPerSample, raw.size() / kMostSamples);
  const std::size_t count = raw.size() / step;
  std::vector<Value> found(count);
  detail::parallel_each_with<SegmentFitter>(count, 64, [&](std::size_t k, auto& fitter) {
    const std::size_t i = k * step + step / 2;
    const auto spacing = static_cast<double>(spacings[i]);
    const double reach = kMapReach * spacing;
    SegmentFit fit = fitter.fit(raw, raw.points()[i], reach, spacing);
    fit = fit_beyond_noise(fitter, raw, raw.points()[i], reach, spacing, fit);
    found[k] = {static_cast<float>(fit.quadric_residual),
                static_cast<float>(fit.quadric_residual * fit.footprint)};
  });
  std::vector<Eigen::Vector3f> positions;
  std::vector<Value> values;
  for (std::size_t k = 0; k < count; ++k) {
    if (!(found[k].product > 0)) continue;
    positions.push_back(raw.points()[k * step + step / 2]);
    values.push_back(found[k]);
  }
  reach_ = kSurroundings * static_cast<float>(median(spacings));
  positions_ = CellGrid(positions);
  for (const std::uint32_t k : positions_.order()) values_.push_back(values[k]);
  typical_ = {static_cast<float>(median_of(values_, &Value::sigma)),
              static_cast<float>(median_of(values_, &Value::product))};
}

NoiseMap::Value NoiseMap::at(const Eigen::Vector3f& point, std::vector<std::uint32_t>& near,
                             std::vector<float>& around) const {
  near.clear();
  positions_.within(point, reach_, near);
  if (near.size() < kFewest) return typical_;
  const auto flatter = [&](float Value::*of) {
    around.clear();
    for (const std::uint32_t k : near) around.push_back(values_[k].*of);
    const auto rank = static_cast<std::ptrdiff_t>(kFlatter * static_cast<double>(near.size() - 1));
    std::nth_element(around.begin(), around.begin() + rank, around.end());
    return around[static_cast<std::size_t>(rank)];
  };
  return {flatter(&Value::sigma), flatter(&Value::product)};
}

LocalNoise NoiseMap::at(std::span<const Eigen::Vector3f> points, const Noise& whole) const {
  LocalNoise local{std::vector<float>(points.size()), std::vector<float>(points.size())};
  detail::parallel_ranges(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    std::vector<float> around;
    for (std::size_t i = begin; i < end; ++i) {
      const Value value = at(points[i], near, around);
      local.sigmas[i] = static_cast<float>(whole.shared) * value.sigma;
      local.products[i] = static_cast<float>(whole.excess) * value.product;
    }
  });
  return local;
}

}  // namespace palpate
