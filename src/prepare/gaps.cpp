// Finds points that hardly any other's support reaches, and bridges the gaps around them.

#include "prepare/gaps.hpp"

#include <algorithm>
#include <cstdint>

#include "geometry/parallel.hpp"
#include "prepare/limit_growth.hpp"
#include "prepare/lines.hpp"
#include "prepare/sheet_fit.hpp"

namespace palpate {
namespace {

constexpr float kFaint = 2.5f;       // sum of weights; a square grid has 5.8; judgement
constexpr float kFirstReach = 1.5f;  // radii; judgement
constexpr int kWidenings = 2;        // reaches tried, each twice the last: gaps up to three radii

}  // namespace

std::size_t close_gaps(const CellGrid& grid, std::span<const float> sums,
                       std::vector<float>& spacings, std::vector<float>& radii, PointFits& own,
                       float largest) {
  std::vector<std::uint32_t> faint;
  for (std::uint32_t i = 0; i < radii.size(); ++i) {
    if (sums[i] < kFaint) faint.push_back(i);
  }
  std::vector<std::uint8_t> raised(faint.size());
  const std::vector<float> before = radii;
  detail::parallel_ranges(faint.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    std::vector<CellGrid::Neighbor> nearest;
    SheetFitter fitter;
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = faint[k];
      const Line line = line_at(grid, i, nearest);
      const float gap = gap_across(grid, i, line, kFirstReach * before[i], kWidenings, near);
      const float wanted = std::min(kUsualMultiple * gap, largest);
      if (!(wanted > before[i])) continue;
      const SheetFit fit = fitter.fit(grid, grid.points()[i], static_cast<double>(wanted),
                                      static_cast<double>(spacings[i]));
      if (!fit.is_sheet(static_cast<double>(wanted), 0)) continue;
      radii[i] = wanted;
      spacings[i] = std::max(spacings[i], wanted / kUsualMultiple);
      take_fit(fit, i, own);
      raised[k] = 1;
    }
  });
  return static_cast<std::size_t>(std::ranges::count(raised, 1));
}

WeightSums close_gaps(const PrepareOptions& options, Sampling& sampling, Radii& radii,
                      PointFits& fits) {
  constexpr float kSlope = 1;  // of R over distance, once gaps are closed; judgement
  WeightSums sums(sampling.grid, radii.values, options.kernel);
  if (options.radius || options.paper || !options.estimate_normals) return sums;
  const std::vector<float> before = radii.values;
  const auto largest = static_cast<float>(largest_radius(sampling.facts));
  if (close_gaps(sampling.grid, sums.own, sampling.spacings, radii.values, fits, largest) == 0) {
    return sums;
  }
  limit_growth(sampling.grid, kSlope, radii.values, &fits);
  sums.update(sampling.grid, before, radii.values, options.kernel);
  return sums;
}

}  // namespace palpate
