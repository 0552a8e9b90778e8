#include "prepare/own_sheets.hpp"

#include <algorithm>

#include "geometry/neighborhoods.hpp"
#include "palpate/geometry/normals.hpp"
#include "prepare/sheet_fit.hpp"

namespace palpate {
namespace {

constexpr double kSmoothFit = 0.03;  // of R that a quadric may leave before others are looked for,
constexpr double kNoisyFit = 1.2;    // of the noise

}  // namespace

OwnSheets fit_own_sheets(const CellGrid& grid, std::span<const float> spacings,
                         std::span<const float> radii, double noise) {
  Normals planes = estimate_normals(grid, radii, kNormalsReach);
  OwnSheets sheets{std::move(planes.normals),
                   std::move(planes.confidences),
                   std::move(planes.residuals),
                   {},
                   std::vector<std::uint8_t>(grid.size())};
  sheets.bends = sheets.residuals;
  std::vector<float> reaches(grid.size());  // of second fits, m; 0: the plane does
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double flat = flat_residual(static_cast<double>(radii[i]), noise);
    if (static_cast<double>(sheets.residuals[i]) > flat) reaches[i] = kNormalsReach * radii[i];
  }
  const auto refit = [&](SheetFitter& fitter, std::uint32_t i,
                         std::span<const std::uint32_t> near) {
    const double smooth = std::max(kSmoothFit * static_cast<double>(radii[i]), kNoisyFit * noise);
    const SheetFit fit = fitter.fit(grid, grid.points()[i], near, static_cast<double>(reaches[i]),
                                    static_cast<double>(spacings[i]), smooth);
    sheets.normals[i] = fit.normal.cast<float>();
    sheets.confidences[i] = static_cast<float>(fit.planarity);
    sheets.residuals[i] = static_cast<float>(fit.residual);
    sheets.bends[i] = static_cast<float>(fit.bend);
    sheets.others[i] = fit.others ? 1 : 0;
  };
  detail::for_each_block(grid, [&](const detail::Block& block, detail::Surroundings& around) {
    SheetFitter fitter;
    detail::NearLists near;
    detail::for_each_part(
        grid, {.of_points = reaches, .of_cells = {}}, block, around,
        [&](std::uint32_t first, std::uint32_t count, std::span<const simd::Run> runs) {
          near.find(grid, first, count, runs, reaches);
          for (std::uint32_t q = 0; q < count; ++q) {
            if (reaches[first + q] > 0) refit(fitter, first + q, near.of(q));
          }
        });
  });
  return sheets;
}

}  // namespace palpate
