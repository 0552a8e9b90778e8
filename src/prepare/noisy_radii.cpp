#include "prepare/noisy_radii.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/parallel.hpp"
#include "palpate/geometry/normals.hpp"

namespace palpate {
namespace {

// Noise tilts normals by 3.2 sigma_n delta / R^2 (field_choice.md section 5).
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

}  // namespace palpate
