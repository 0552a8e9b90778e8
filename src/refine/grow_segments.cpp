// Joins points whose planes continue each other into smooth segments.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/near_pairs.hpp"
#include "refine/segments.hpp"
#include "refine/signed_graph.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// When two points continue each other's segment; judgement (docs/preparation.md, Segments).
constexpr float kPairReach = 1.6f;  // spacings
// Angle that normals of one segment may turn, or more, rad (16 degrees). Points of a block that
// turn by half of it at most are joined as they come, for time: a half-twisted band whose rows turn
// by 9 degrees parts at the twist, wherever the borders of blocks are (tests).
constexpr float kTurn = 0.28f;
constexpr float kTolerance =
    0.15f;  // spacings; a point may be off by three of these, or of the noise

constexpr std::uint32_t kFewestOnSegment = 8;  // points of a segment; fewer prove little; judgement
// Factor on the confidence of points of smaller segments; judgement.
constexpr float kTrustOfFew = 0.1f;

/// Contracts a signed graph of points. An edge is for the sign of two normals whose points continue
/// each other's segments, and against it where they lie over each other: the two sides of a blade
/// continue each other at its edge, where they are too near to be separated, but are not one
/// segment. Where no signs agree all around, as beside a fold that is too thin to separate its
/// sides, segments part where the fewest points continue each other.
class SegmentGrowing {
 public:
  /// `assigned`: of each point the one whose fit it has; kUnassigned: it is on no segment.
  SegmentGrowing(const SegmentInput& input, const PointFits& own,
                 const std::vector<std::uint32_t>& assigned)
      : input_(input), own_(own), assigned_(assigned), sets_(input.grid().size() + 1) {
    curvatures_.reserve(assigned.size());
    for (std::uint32_t i = 0; i < assigned.size(); ++i) {
      curvatures_.push_back(fitted_curvature(input, own, i));
    }
  }

  SignedGraph run() {
    std::vector<std::vector<SignedEdge>> edges(input_.graph.blocks());
    input_.graph.for_each_block<detail::NearPairs>([&](const auto& rows, auto& pairs) {
      const auto reach = [this](std::uint32_t i) { return kPairReach * input_.spacings[i]; };
      rows.each([&](const detail::NeighborRow& row) {
        pairs.each(input_.grid(), row, reach, [&](std::uint32_t i, std::uint32_t j) {
          meet(i, j, rows.block(), edges[rows.number()]);
        });
      });
    });
    SignedGraph graph(std::move(sets_));
    for (auto& of_block : edges) {
      for (const SignedEdge& edge : of_block) graph.add(edge);
      of_block = {};
    }
    graph.contract();
    return graph;
  }

 private:
  /// What i and j, which are near each other, say of each other. Compares their assigned planes: at
  /// a sharp rim, where two sides meet, these are as far apart as the sides are.
  void meet(std::uint32_t i, std::uint32_t j, const detail::Block& block,
            std::vector<SignedEdge>& edges) {
    if (i == j || assigned_[i] == kUnassigned || assigned_[j] == kUnassigned) return;
    const float squared = (input_.grid().points()[j] - input_.grid().points()[i]).squaredNorm();
    const float reach = kPairReach * input_.spacings[j];
    if (i > j && squared <= reach * reach) return;  // they meet from j
    const bool inside = j >= block.begin && j < block.end;
    if (inside && sets_.find(i).first == sets_.find(j).first) return;
    const std::uint32_t a = assigned_[i];
    const std::uint32_t b = assigned_[j];
    const Vector3f offset = input_.grid().points()[b] - input_.grid().points()[a];
    const float curved = kTurnMargin * std::min(curvatures_[a], curvatures_[b]) * offset.norm();
    const float turn = std::max(kTurn, curved);
    const float cosine = own_.normals[i].dot(own_.normals[j]);
    if (std::abs(cosine) < 1 - 0.5f * turn * turn) return;
    const float off =
        std::max(std::abs(own_.normals[a].dot(offset)), std::abs(own_.normals[b].dot(offset)));
    const int sign = cosine < 0 ? -1 : 1;
    if (off > segment_tolerance(input_, a, b) && off > arc(a, b, curved, std::sqrt(squared))) {
      const bool over = a == i && b == j && lie_over(i, j, offset);
      if (over) edges.push_back({i, j, EdgeWeight::cannot_link(sign)});
    } else if (inside && std::abs(cosine) >= 1 - 0.125f * kTurn * kTurn) {
      sets_.join(i, j, sign);
    } else {
      edges.push_back({i, j, EdgeWeight(sign)});
    }
  }

  /// How far points `near` each other may be off each other's planes, those of a and b, on an arc
  /// that turns by `curved` (rad) between these at most, m.
  [[nodiscard]] float arc(std::uint32_t a, std::uint32_t b, float curved, float near) const {
    // An arc's normals turn by twice as much as it leaves their planes.
    const float turned =
        std::sqrt(std::max(0.f, 2 - 2 * std::abs(own_.normals[a].dot(own_.normals[b]))));
    const float length = (input_.grid().points()[b] - input_.grid().points()[a]).norm();
    return kChord * std::max(kTurn * near, std::min(curved, turned + kTurn) * length);
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
  SignedGraph graph = SegmentGrowing(input, own, snapped.assigned).run();
  const std::size_t count = input.grid().size();
  std::vector<std::uint32_t>& segment = result.segments.segment;
  segment.assign(count, SurfacePoints::Segments::kNone);
  std::vector<std::uint32_t> sizes;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (snapped.assigned[i] == kUnassigned) continue;
    const auto [root, sign] = graph.find(i);
    if (sign < 0) own.normals[i] = -own.normals[i];
    if (segment[root] == SurfacePoints::Segments::kNone) {
      segment[root] = static_cast<std::uint32_t>(sizes.size());
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
