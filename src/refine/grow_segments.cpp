// Joins points whose planes continue each other into smooth segments.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "geometry/near_pairs.hpp"
#include "geometry/signed_sets.hpp"
#include "refine/cannot_link_sets.hpp"
#include "refine/segments.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// When two points continue each other's segment; judgement (docs/preparation.md, Segments).
constexpr float kPairReach = 1.6f;  // spacings
constexpr float kTurn = 0.28f;  // rad (16 degrees) that normals of one segment may turn, or more
constexpr float kTolerance =
    0.15f;  // spacings; a point may be off by three of these, or of the noise

constexpr std::uint32_t kFewestOnSegment = 8;  // points of a segment; fewer prove little; judgement
// Factor on the confidence of points of smaller segments; judgement.
constexpr float kTrustOfFew = 0.1f;

// Points whose normals turn by no more than this are joined as they come, for time; measured: with
// half of it signs are the same, with twice of it twice as many are wrong (docs/preparation.md).
constexpr float kParallel = 0.5f * kTurn;  // rad

struct Pair {
  std::uint32_t a;
  std::uint32_t b;
  int sign;
  float skew;  // 1 - cosine of the angle between the normals
};

/// Pairs of points of a block that wait until those with parallel normals in it are joined.
struct Later {
  std::vector<Pair> parallel;  // across blocks
  std::vector<Pair> turning;   // continue each other, and are not parallel
  std::vector<Pair> stacked;   // cannot link: one lies over the other
};

/// Joins points that continue each other's segments: those with parallel normals within each block
/// on its own, all others afterwards, the most parallel first. So signs spread from normal to
/// normal where they turn the least (Hoppe et al., Surface reconstruction from unorganized points,
/// 1992). Where no signs agree all around, as beside a fold that is too thin to separate its sides,
/// they separate where normals turn the most.
class SegmentGrowing {
 public:
  /// `assigned`: of each point the one whose fit it has; kUnassigned: it is on no segment.
  SegmentGrowing(const SegmentInput& input, const PointFits& own,
                 const std::vector<std::uint32_t>& assigned)
      : input_(input), own_(own), assigned_(assigned), sets_(input.grid().size()) {
    curvatures_.reserve(assigned.size());
    for (std::uint32_t i = 0; i < assigned.size(); ++i) {
      curvatures_.push_back(fitted_curvature(input, own, i));
    }
  }

  detail::SignedSets& run() {
    std::vector<Later> later(input_.graph.blocks());
    input_.graph.for_each_block<detail::NearPairs>([&](const auto& rows, auto& pairs) {
      const auto reach = [this](std::uint32_t i) { return kPairReach * input_.spacings[i]; };
      rows.each([&](const detail::NeighborRow& row) {
        pairs.each(input_.grid(), row, reach, [&](std::uint32_t i, std::uint32_t j) {
          meet(i, j, rows.block(), later[rows.number()]);
        });
      });
    });
    join(later);
    return sets_;
  }

 private:
  void join(const std::vector<Later>& later) {
    CannotLinkSets constrained(sets_, input_.grid().size());
    for (const Later& block : later) {
      for (const Pair& pair : block.stacked) constrained.add_cannot_link(pair.a, pair.b, pair.sign);
    }
    for (const Later& block : later) {
      for (const Pair& pair : block.parallel) constrained.join(pair.a, pair.b, pair.sign);
    }
    std::vector<Pair> turning;
    for (const Later& block : later) {
      std::ranges::copy_if(block.turning, std::back_inserter(turning), [this](const Pair& pair) {
        return sets_.find(pair.a).first != sets_.find(pair.b).first;
      });
    }
    std::ranges::stable_sort(turning, {}, &Pair::skew);
    for (const Pair& pair : turning) constrained.join(pair.a, pair.b, pair.sign);
  }

  /// Joins i and j, which are near each other, if they lie on one segment. Compares their assigned
  /// planes: at a sharp rim, where two sides meet, these are as far apart as the sides are.
  void meet(std::uint32_t i, std::uint32_t j, const detail::Block& block, Later& later) {
    if (i == j || assigned_[i] == kUnassigned || assigned_[j] == kUnassigned) return;
    const bool inside = j >= block.begin && j < block.end;
    if (inside && sets_.find(i).first == sets_.find(j).first) return;
    const std::uint32_t a = assigned_[i];
    const std::uint32_t b = assigned_[j];
    const Vector3f offset = input_.grid().points()[b] - input_.grid().points()[a];
    const float length = offset.norm();
    const float near = (input_.grid().points()[j] - input_.grid().points()[i]).norm();
    const float curvature = std::min(curvatures_[a], curvatures_[b]);
    const float turn = std::max(kTurn, kTurnMargin * curvature * length);
    const float cosine = own_.normals[i].dot(own_.normals[j]);
    if (std::abs(cosine) < 1 - 0.5f * turn * turn) return;
    const float off =
        std::max(std::abs(own_.normals[a].dot(offset)), std::abs(own_.normals[b].dot(offset)));
    // An arc's normals turn by twice as much as it leaves their planes.
    const float turned =
        std::sqrt(std::max(0.f, 2 - 2 * std::abs(own_.normals[a].dot(own_.normals[b]))));
    const float arc_turn = std::min(kTurnMargin * curvature * length, turned + kTurn);
    const float arc = kChord * std::max(kTurn * near, arc_turn * length);
    const Pair pair{i, j, cosine < 0 ? -1 : 1, 1 - std::abs(cosine)};
    if (off > std::max(segment_tolerance(input_, a, b), arc)) {
      if (a == i && b == j && lie_over(i, j, offset)) later.stacked.push_back(pair);
    } else if (pair.skew > 0.5f * kParallel * kParallel) {
      later.turning.push_back(pair);
    } else if (inside) {
      sets_.join(i, j, pair.sign);
    } else {
      later.parallel.push_back(pair);
    }
  }

  /// Does each lie over the other's plane rather than beside the other?
  [[nodiscard]] bool lie_over(std::uint32_t i, std::uint32_t j, const Vector3f& offset) const {
    const float height =
        std::min(std::abs(own_.normals[i].dot(offset)), std::abs(own_.normals[j].dot(offset)));
    const float aside = std::sqrt(std::max(0.f, offset.squaredNorm() - height * height));
    return height > segment_tolerance(input_, i, j) && height >= kGapSlope * aside;
  }

  const SegmentInput& input_;
  const PointFits& own_;
  const std::vector<std::uint32_t>& assigned_;
  std::vector<float> curvatures_;  // of each point's fit, 1/m
  detail::SignedSets sets_;
};

}  // namespace

std::vector<float> segment_reaches(std::span<const float> spacings, std::span<const float> radii,
                                   bool seen) {
  std::vector<float> reaches(radii.size());
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    reaches[i] = std::max(kPairReach * spacings[i], look_reach(seen) * radii[i]);
  }
  return reaches;
}

float segment_tolerance(const SegmentInput& input, std::uint32_t i, std::uint32_t j) {
  return 3 * std::max(std::max(input.noise[i], input.noise[j]),
                      kTolerance * std::min(input.spacings[i], input.spacings[j]));
}

GrownSegments grow_segments(const SegmentInput& input, PointFits& own) {
  GrownSegments result;
  Snapped snapped = snap_to_planes(input, own);
  result.confident = std::move(snapped.confident);
  result.second_planes = std::move(snapped.second_planes);
  SegmentGrowing growing(input, own, snapped.assigned);
  detail::SignedSets& sets = growing.run();
  const std::size_t count = input.grid().size();
  std::vector<std::uint32_t>& segment = result.segments.segment;
  segment.assign(count, SurfacePoints::Segments::kNone);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (snapped.assigned[i] == kUnassigned) continue;
    const auto [root, sign] = sets.find(i);
    if (sign < 0) own.normals[i] = -own.normals[i];
    if (root == i) {  // before all others of its segment
      segment[i] = static_cast<std::uint32_t>(sizes.size());
      sizes.push_back(0);
    }
    ++sizes[segment[i] = segment[root]];
  }
  std::erase_if(result.second_planes, [&](const SecondPlane& second) {
    return segment[second.point] == segment[second.owner];
  });
  result.segments.component.resize(sizes.size());
  std::iota(result.segments.component.begin(), result.segments.component.end(), 0u);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (segment[i] != SurfacePoints::Segments::kNone && sizes[segment[i]] < kFewestOnSegment) {
      own.confidences[i] *= kTrustOfFew;
    }
  }
  return result;
}

}  // namespace palpate
