// Chooses the support radius R of each point.

#include "prepare/radii.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/normals.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/limit_radii.hpp"

namespace palpate {
namespace {

// Noise tilts normals by 3.2 sigma_n delta / R^2 (docs/method.md 5.3).
constexpr double kNoiseToTilt = 3.2;

// No R is above this many floors, or as many times 2.5 spacings: more smoothing would cost shape
// and time, and noise that needs it is the sensor's to filter; judgement.
constexpr double kMostFloors = 2.4;

// Rms distance from the plane, in R. Noise gives theta R / (3.2 s), about 0.03; a sphere of four R
// 0.04; a right angle 0.2.
constexpr float kCurved = 0.08f;  // R begins to shrink; judgement
constexpr float kEdge = 0.14f;    // R shrinks no further; judgement
constexpr float kShrink = 0.25f;  // share of R; measured (docs/preparation.md, Support radius)

}  // namespace

std::vector<float> noisy_radii(const CellGrid& grid, const LocalNoise& noise, double normal_error,
                               std::vector<float> floors) {
  const double scale = kNoiseToTilt / normal_error;
  std::vector<float> radii = noise.products;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double radius = std::sqrt(scale * static_cast<double>(radii[i]));
    const float most = static_cast<float>(kMostFloors) * floors[i];
    radii[i] = std::clamp(static_cast<float>(radius), floors[i], most);
    const float layer = static_cast<float>(kSigmasInReach) * noise.sigmas[i];
    floors[i] = std::clamp(layer, floors[i], most);
    radii[i] = std::max(radii[i], floors[i]);
  }
  shrink_at_edges(grid, floors, radii);
  return radii;
}

void shrink_at_edges(const CellGrid& grid, const std::vector<float>& floors,
                     std::vector<float>& radii) {
  const std::vector<float> residuals = estimate_normals(grid, radii).residuals;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const float curved = (residuals[i] / radii[i] - kCurved) / (kEdge - kCurved);
    radii[i] = std::max(floors[i], radii[i] * (1 - kShrink * std::clamp(curved, 0.0f, 1.0f)));
  }
}

namespace {

// No R is above this part of the cloud's size for noise's sake; judgement.
constexpr double kFinestShape = 25;

constexpr float kSlope = 0.5f;  // of R over distance; judgement (docs/method.md 5.3)

/// R by spacing and noise, which is taken point by point where the cloud was thinned for it.
std::vector<float> radii_by_noise(const Sampling& sampling, const PrepareOptions& options) {
  const CloudFacts& facts = sampling.facts;
  const bool by_point = !sampling.local.products.empty();
  const double noise = by_point ? 0 : facts.noise.sigma;
  const double finest = std::max(facts.extent.size().norm(), kLoneSpacing) / kFinestShape;
  std::vector<float> radii(sampling.spacings.size());
  std::ranges::transform(sampling.spacings, radii.begin(), [&](float of_point) {
    const auto spacing = static_cast<double>(of_point);
    const double footprint = sampling.voxel > 0 ? facts.spacing : spacing;
    const double for_noise =
        std::min({std::sqrt(kNoiseToTilt * noise * footprint / options.normal_error),
                  kMostFloors * kUsualMultiple * spacing, finest});
    return static_cast<float>(
        std::max({kUsualMultiple * spacing, options.minimum_radius, for_noise}));
  });
  if (!by_point) return radii;
  return noisy_radii(sampling.grid, sampling.local, options.normal_error, std::move(radii));
}

/// R of all points; which of them are outliers is decided later.
std::vector<float> radii_of(const Sampling& sampling, const PrepareOptions& options) {
  const auto all = [&](double radius) {
    return std::vector<float>(sampling.grid.size(), static_cast<float>(radius));
  };
  if (options.radius) return all(std::max(*options.radius, options.minimum_radius));
  if (options.paper) return all(options.smoothing * kUsualMultiple * sampling.spacing);
  std::vector<float> radii = radii_by_noise(sampling, options);
  for (float& radius : radii) {
    radius = std::max(static_cast<float>(options.smoothing) * radius,
                      static_cast<float>(options.minimum_radius));
  }
  limit_radii(sampling.grid, kSlope, radii);
  const auto largest = static_cast<float>(largest_radius(sampling.facts));
  for (float& radius : radii) radius = std::min(radius, largest);
  return radii;
}

}  // namespace

double largest_radius(const CloudFacts& facts) {
  // Typical ones: the sparsest points of a level have 6 (Division), and closing a gap may double
  // that; derived.
  constexpr double kMost = 12;
  return facts.radius > 0 ? kMost * facts.radius : std::numeric_limits<double>::infinity();
}

Radii choose_radii(const Sampling& sampling, const PrepareOptions& options) {
  return {radii_of(sampling, options), {}};
}

}  // namespace palpate
