// Finds the holes beside points, and bridges those that are gaps between points.

#include "refine/gaps.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "geometry/near_pairs.hpp"
#include "prepare/limit_radii.hpp"
#include "prepare/plane_fits.hpp"
#include "prepare/segment_fit.hpp"
#include "refine/holes.hpp"

namespace palpate {
namespace {

constexpr float kFaint = 2.5f;  // sum of weights; a square grid has 5.8; judgement

// The field ends a surface where its weight is below 0.3, as it is in the middle of an empty disc
// of 0.55 R: T(0.55) = 0.3 of the default kernel (docs/method.md 2.1, 2.5); derived.
constexpr float kBridged = 0.55f;  // R
// Such a disc beside a point moves the mean of its neighbours by 0.14 of their reach where they are
// spread evenly; half of that. Near-duplicates of the point and other segments move it less.
constexpr float kBesideHole = 0.07f;  // derived, with a margin
// Discs up to this are gaps between points, wider ones are holes of the surface. The widest among N
// points that lie anywhere is sqrt(ln N / pi) spacings: 0.8 R of 300,000; derived.
constexpr float kWidestHole = 0.8f;    // R
constexpr float kFaintWidestHole = 3;  // R of faint points, which is too small; judgement

// R over the hole's radius: that of the square grid with such holes, so that a segment that turns
// sparse keeps its 2.5 spacings; derived.
constexpr float kAsOnGrid = std::numbers::sqrt2_v<float> * kUsualMultiple;
// Where no segment goes on so far: the hole's middle has a weight of T(0.4) = 0.56; derived.
constexpr float kAtLeast = 2.5f;

/// What bridges a hole: R (m; 0: nothing does) and the segment within it.
struct Bridge {
  float radius = 0;
  SegmentFit segment;
};

/// A point that may be beside a hole. Lengths in m.
struct Beside {
  std::uint32_t point;
  float radius;  // R
  float widest;  // radius of a hole that is bridged
  float spacing;
  float noise;
  Eigen::Vector3f normal;  // of its plane; zero: it has none
};

/// Finds the bridges over the holes beside one point after another.
class Closer {
 public:
  Closer(const CellGrid& grid, float largest) : grid_(grid), largest_(largest) {}

  /// `near` and `around`: the points that HoleFinder::radius_beside() wants.
  [[nodiscard]] Bridge bridge(const Beside& at, std::span<const std::uint32_t> near,
                              std::span<const std::uint32_t> around) {
    Eigen::Vector3f normal = at.normal;
    if (normal.isZero()) normal = fit_within(2 * at.widest, at.point, 0).normal.cast<float>();
    if (normal.isZero()) return {};
    const float hole = holes_.radius_beside(grid_, at.point, near, around, normal,
                                            kBridged * at.radius, at.widest);
    for (const float times : {kAsOnGrid, kAtLeast}) {
      const float wanted = std::min(times * hole, largest_);
      if (!(wanted > at.radius) || hole > kBridged * wanted) return {};
      const SegmentFit fit = fit_within(wanted, at.point, at.spacing);
      if (fit.is_segment(static_cast<double>(wanted), static_cast<double>(at.noise))) {
        return {wanted, fit};
      }
    }
    return {};
  }

 private:
  [[nodiscard]] SegmentFit fit_within(float reach, std::uint32_t i, float spacing) {
    return fitter_.fit(grid_, grid_.points()[i], static_cast<double>(reach),
                       static_cast<double>(spacing));
  }

  const CellGrid& grid_;
  float largest_;  // R, m
  HoleFinder holes_;
  SegmentFitter fitter_;
};

}  // namespace

std::size_t close_gaps(const detail::NeighborhoodGraph& graph, std::span<const float> sums,
                       std::span<const float> noise, std::vector<float>& spacings,
                       std::vector<float>& radii, PointFits& own, float largest) {
  const CellGrid& grid = graph.grid();
  std::vector<float> reaches(grid.size());  // m; 0: no hole is beside the point
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    const bool beside = own.asides[i] > kBesideHole || own.others[i] != 0;
    if (sums[i] < kFaint || beside) reaches[i] = kBridged * radii[i];
  }
  std::vector<std::uint8_t> raised(grid.size());
  const auto close = [&](Closer& closer, std::uint32_t i, std::span<const std::uint32_t> near,
                         std::span<const std::uint32_t> around) {
    const float widest = (sums[i] < kFaint ? kFaintWidestHole : kWidestHole) * radii[i];
    const Bridge bridge =
        closer.bridge({i, radii[i], widest, spacings[i], noise[i], own.normals[i]}, near, around);
    if (bridge.radius <= 0) return;
    radii[i] = bridge.radius;
    spacings[i] = std::max(spacings[i], bridge.radius / kUsualMultiple);
    take_fit(bridge.segment, i, own);
    raised[i] = 1;
  };
  detail::for_each_near(
      graph, reaches, [&] { return Closer(grid, largest); }, close);
  return static_cast<std::size_t>(std::ranges::count(raised, 1));
}

void refine_gaps(Surfels& s) {
  constexpr float kSlope = 1;  // of R over distance, once gaps are closed; judgement
  const PrepareOptions& options = s.options;
  if (options.radius || options.paper || !options.estimate_normals) return;
  Sampling& sampling = s.sampling;
  const std::vector<float> before = s.radii.values;
  const auto largest = static_cast<float>(largest_radius(sampling.facts));
  if (close_gaps(s.graph, s.sums.own, sampling.local.sigmas, sampling.spacings, s.radii.values,
                 s.fits, largest) == 0) {
    return;
  }
  limit_radii(sampling.grid, kSlope, s.radii.values, &s.fits);
  widen(s.graph, s.radii.values);
  s.sums.update(s.graph, before, s.radii.values, options.kernel);
}

}  // namespace palpate
