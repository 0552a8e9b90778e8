// Chooses the support radius R of each point.

#include "prepare/radii.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "geometry/neighborhoods.hpp"
#include "geometry/normals.hpp"
#include "geometry/parallel.hpp"
#include "palpate/geometry/spacing.hpp"
#include "prepare/places.hpp"
#include "prepare/plane_fits.hpp"
#include "prepare/strays.hpp"

namespace palpate {
namespace {

// Nearest points, the point itself and copies of its position among them; judgement.
constexpr std::size_t kLooked = 9;

// Nearest distance in spacings. Measured: random points 0.52; meshes, frames and jittered grids
// 0.71 and above (docs/preparation.md, Support radius).
constexpr double kIrregular = 0.65;

}  // namespace

double nearest_share(const CellGrid& grid, std::span<const float> spacings) {
  std::vector<float> shares;
  std::vector<CellGrid::Neighbor> near;
  each_sample(grid, [&](std::uint32_t i) {
    grid.nearest(grid.points()[i], kLooked, near);
    const auto other =
        std::ranges::find_if(near, [](const auto& found) { return found.squared_distance > 0; });
    if (other != near.end()) shares.push_back(std::sqrt(other->squared_distance) / spacings[i]);
  });
  return shares.empty() ? 1 : median(shares);
}

bool is_irregular(const CellGrid& grid, std::span<const float> spacings) {
  return nearest_share(grid, spacings) < kIrregular;
}

namespace {

constexpr float kMatters = 0.8f;  // of the point's R: only a smaller limit is applied; judgement
constexpr std::uint32_t kBlockPoints = 64;  // that share one list of leaves; judgement, for speed
constexpr float kPlane = 0.5f;   // confidence from which on a point has a plane; judgement
constexpr float kResiduals = 3;  // off the plane, in its residuals: three sigma
constexpr float kOff = 0.12f;    // off the plane, of the distance (7 degrees); judgement

/// The limits of one block after another.
class Limiter {
 public:
  Limiter(const CellGrid& grid, float slope, const std::vector<float>& radii,
          const std::vector<float>& smallest, const OwnSheets* own)
      : grid_(grid), slope_(slope), radii_(radii), smallest_(smallest), own_(own) {}

  /// limits: of all points; those of the block are written.
  void limit(const detail::Block& block, std::vector<float>& limits) {
    find_leaves(block);
    for (std::uint32_t i = block.begin; i < block.end; ++i) limits[i] = limit_at(i);
  }

 private:
  /// A leaf and the least that its points can limit those of the block to, m.
  struct Leaf {
    float bound;
    std::uint32_t cell;
  };

  /// The leaves that may limit a point of the block, the strictest first.
  void find_leaves(const detail::Block& block) {
    const auto own = radii_.begin();
    const float largest = kMatters * *std::max_element(own + block.begin, own + block.end);
    leaves_.clear();
    std::array<std::uint32_t, CellGrid::kMaxStack> stack;
    std::size_t open = 0;
    stack[open++] = 0;
    while (open > 0) {
      const std::uint32_t index = stack[--open];
      if (smallest_[index] >= largest) continue;
      const CellGrid::Cell& cell = grid_.cells()[index];
      const float squared = detail::squared_distance(cell, block.lower, block.upper);
      const float bound = smallest_[index] + slope_ * std::sqrt(squared);
      if (bound >= largest) continue;
      for (std::uint32_t k = 0; k < cell.children; ++k) stack[open++] = cell.first_child + k;
      if (cell.children == 0) leaves_.push_back({bound, index});
    }
    std::sort(leaves_.begin(), leaves_.end(),
              [](const Leaf& a, const Leaf& b) { return a.bound < b.bound; });
  }

  /// min_j (R_j + distance / 2).
  [[nodiscard]] float limit_at(std::uint32_t i) const {
    const Eigen::Vector3f& p = grid_.points()[i];
    const float matters = kMatters * radii_[i];
    float limit = matters;
    for (const Leaf& leaf : leaves_) {
      if (leaf.bound >= limit) break;
      const CellGrid::Cell& cell = grid_.cells()[leaf.cell];
      const float bound = slope_ * std::sqrt(detail::squared_distance(cell, p));
      if (smallest_[leaf.cell] + bound >= limit) continue;
      for (std::uint32_t j = cell.begin; j < cell.end; ++j) {
        const float distance = std::sqrt(detail::squared_distance(grid_.points()[j], p));
        const float limited = radii_[j] + slope_ * distance;
        if (limited < limit && !on_plane(i, j, distance)) limit = limited;
      }
    }
    return limit < matters ? limit : radii_[i];
  }

  /// Does j lie on the plane of i, as far as one can tell?
  [[nodiscard]] bool on_plane(std::uint32_t i, std::uint32_t j, float distance) const {
    if (!own_ || own_->confidences[i] < kPlane) return false;
    const float off = std::abs(own_->normals[i].dot(grid_.points()[j] - grid_.points()[i]));
    return off <= std::max(kResiduals * own_->residuals[i], kOff * distance);
  }

  const CellGrid& grid_;
  float slope_;  // of R over distance
  const std::vector<float>& radii_;
  const std::vector<float>& smallest_;
  const OwnSheets* own_;
  std::vector<Leaf> leaves_;
};

}  // namespace

void limit_growth(const CellGrid& grid, float slope, std::vector<float>& radii,
                  const OwnSheets* own) {
  if (radii.empty()) return;
  const auto [low, high] = std::minmax_element(radii.begin(), radii.end());
  if (*low >= kMatters * *high) return;
  const std::vector<float> smallest = detail::smallest_in_cells(grid, radii);
  const std::vector<detail::Block> blocks = detail::make_blocks(grid, kBlockPoints);
  std::vector<float> limited(radii.size());
  detail::parallel_ranges(blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
    Limiter limiter(grid, slope, radii, smallest, own);
    for (std::size_t b = begin; b < end; ++b) limiter.limit(blocks[b], limited);
  });
  radii = std::move(limited);
}

namespace {

// Noise tilts normals by 3.2 sigma_n delta / R^2 (docs/method.md 5.3).
constexpr double kNoiseToTilt = 3.2;

// No R is above this many floors (2.5 spacings each): more smoothing would cost shape and time, and
// noise that needs it is the sensor's to filter; judgement.
constexpr float kMostFloors = 2.4f;

// Rms distance from the plane, in R. Noise gives theta R / (3.2 s), about 0.03; a sphere of four R
// 0.04; a right angle 0.2.
constexpr float kBends = 0.08f;     // R begins to shrink; judgement
constexpr float kEdge = 0.14f;      // R shrinks no further; judgement
constexpr float kShrink = 0.25f;    // share of R; measured (docs/preparation.md, Support radius)
constexpr float kSmoothing = 0.5f;  // R within which radii are averaged; judgement

}  // namespace

std::vector<float> noisy_radii(const CellGrid& grid, const LocalNoise& noise, double normal_error,
                               std::vector<float> floors) {
  const double scale = kNoiseToTilt / normal_error;
  std::vector<float> radii = noise.products;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double radius = std::sqrt(scale * static_cast<double>(radii[i]));
    radii[i] = std::clamp(static_cast<float>(radius), floors[i], kMostFloors * floors[i]);
    const float layer = static_cast<float>(kSigmasInReach) * noise.sigmas[i];
    floors[i] = std::clamp(layer, floors[i], kMostFloors * floors[i]);
    radii[i] = std::max(radii[i], floors[i]);
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
  detail::parallel_each_with<std::vector<std::uint32_t>>(
      radii.size(), 1024, [&](std::size_t i, auto& near) {
        near.clear();
        grid.within(grid.points()[i], kSmoothing * radii[i], near);
        float sum = 0;
        for (const std::uint32_t k : near) sum += small[k];
        if (!near.empty()) radii[i] = std::max(floors[i], sum / static_cast<float>(near.size()));
      });
}

namespace {

// The paper's multiple m of spacings (section V); docs/method.md 5.3.
constexpr double kPaperMultiple = 2.5;

// Noise is not smoothed away at the price of shape of this part of the cloud's size; judgement.
constexpr double kFinestShape = 25;

// R in spacings at least, where points lie irregularly: gaps between random points are wider than
// 2.5 spacings' support bridges. Measured: tests/scene/no_holes_test.cpp.
constexpr double kIrregularMultiple = 3;

// R of strays, in typical spacings: they are not to reach what is sampled finely; judgement.
constexpr float kStrayRadius = 2.5f;

constexpr float kSlope = 0.5f;  // of R over distance; judgement (docs/method.md 5.3)

/// R by spacing and noise, which is taken from place to place where the cloud was thinned for it.
std::vector<float> radii_by_noise(const Sampling& sampling, const PrepareOptions& options) {
  const CloudFacts& facts = sampling.facts;
  const bool by_place = !sampling.local.products.empty();
  const double noise = by_place ? 0 : facts.noise.sigma;
  const double multiple = support_multiple(noise, sampling.spacing);
  const bool irregular = facts.irregular && sampling.voxel <= 0;
  const SupportOptions support{
      .multiple = options.radius_multiple.value_or(
          irregular ? std::max(kIrregularMultiple, multiple) : multiple),
      .noise = noise,
      .footprint = sampling.voxel > 0 ? facts.spacing : 0,
      .normal_error = options.normal_error,
      .minimum = options.minimum_radius,
      .finest_shape = std::max(facts.extent.size().norm(), kLoneSpacing) / kFinestShape};
  std::vector<float> radii = support_radii(sampling.spacings, support);
  if (!by_place) return radii;
  return noisy_radii(sampling.grid, sampling.local, options.normal_error, std::move(radii));
}

}  // namespace

double largest_radius(const CloudFacts& facts) {
  // Typical R: twice those of the sparsest points of a level (Division), as gaps ask for; derived.
  constexpr double kMost = 12;
  return facts.radius > 0 ? kMost * facts.radius : std::numeric_limits<double>::infinity();
}

Radii choose_radii(const Sampling& sampling, const PrepareOptions& options) {
  const auto all = [&](double radius) {
    return Radii{std::vector<float>(sampling.grid.size(), static_cast<float>(radius)), {}};
  };
  if (options.radius) return all(std::max(*options.radius, options.minimum_radius));
  if (options.paper)
    return all(options.radius_multiple.value_or(kPaperMultiple) * sampling.spacing);
  Radii radii{radii_by_noise(sampling, options), {}};
  limit_growth(sampling.grid, kSlope, radii.values);
  const auto largest = static_cast<float>(largest_radius(sampling.facts));
  for (float& radius : radii.values) radius = std::min(radius, largest);
  if (!options.remove_speckle || !options.estimate_normals) return radii;
  radii.strays = find_strays(sampling.grid, sampling.spacings, sampling.spacing);
  for (std::size_t i = 0; i < radii.strays.size(); ++i) {
    if (radii.strays[i] != 0) {
      radii.values[i] = kStrayRadius * static_cast<float>(sampling.spacing);
    }
  }
  return radii;
}

}  // namespace palpate
