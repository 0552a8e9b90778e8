#include "prepare/noise_map.hpp"

#include <algorithm>

#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/sheet_fit.hpp"

namespace palpate {
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

}  // namespace palpate
