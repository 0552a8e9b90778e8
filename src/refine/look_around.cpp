// Lets pairs of points vote on how their segments lie, and finds those that another segment hides.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "field/formulas.hpp"
#include "geometry/near_pairs.hpp"
#include "prepare/plane_fits.hpp"
#include "refine/segments.hpp"

namespace palpate {
namespace {

using Eigen::Vector3f;

// Which points belong to another segment above or below one; all are judgement.
constexpr float kGapReach = 1.6f;   // R
constexpr float kGapTube = 1.3f;    // spacings to the side
constexpr float kGapCosine = 0.8f;  // of the angle between both normals, at least (37 degrees)
constexpr float kGapResiduals = 3;  // least height, in residuals: three sigma

// Factor on the squared slope where points are picked for a closer look.
constexpr float kSafe = 0.999f;  // derived: rounding takes less

// Votes of one segment on another; all are judgement.
constexpr float kVoteReach = 1.3f;  // R
static_assert(kVoteReach <= kNeighborsReach, "the graph has to hold it");
constexpr std::size_t kVoteSegments = 4;  // other segments that a point votes on
constexpr int kVotesEach = 3;             // points of each, the nearest

/// Looks from the points of one block at other segments.
class Outlook {
 public:
  Outlook(const SegmentInput& input, const PointFits& own, const std::optional<Vector3f>& eye,
          GrownSegments& grown)
      : input_(input), own_(own), viewer_(eye), grown_(grown), segments_(grown.segments) {}

  void look(const detail::NeighborhoodGraph::BlockRows& rows, std::vector<SignedEdge>& votes) {
    rows.each([&](const detail::NeighborRow& row) {
      if (!alone(row)) look_from(row, votes);
    });
  }

 private:
  /// Is there but one segment, and does it not curl so far that it may hide itself?
  [[nodiscard]] bool alone(const detail::NeighborRow& row) const {
    // A point of one segment that hides another is turned from it by 143 degrees or more
    // (kGapCosine), so one of the two by half of that from the first.
    constexpr float kSquaredCurl = 0.5f * (1 - kGapCosine);
    const std::uint32_t segment = segments_.segment[row.first];
    const Vector3f& n = own_.normals[row.first];
    return std::ranges::all_of(row.neighbors, [&](std::uint32_t j) {
      if (segments_.segment[j] != segment) return false;
      if (!viewer_) return true;
      const float cosine = n.dot(own_.normals[j]);
      return cosine > 0 && cosine * cosine > kSquaredCurl;
    });
  }

  void look_from(const detail::NeighborRow& row, std::vector<SignedEdge>& votes) {
    const auto [first, count, neighbors] = row;
    simd::Eyes eyes = {};
    eyes.squared_slope = kSafe * kGapSlope * kGapSlope;
    eyes.segments = segments_.segment.data();
    for (std::uint32_t q = 0; q < count; ++q) {
      others_[q].clear();
      eyes_[q] = eye_at(first + q);
      for (Eigen::Index axis = 0; axis < 3; ++axis) eyes.normal[axis][q] = eyes_[q].normal[axis];
      const float reach = own_.confidences[first + q] > 0 ? reach_ * input_.radii[first + q] : 0;
      eyes.squared_reach[q] = reach * reach;
      eyes.least[q] = eyes_[q].least;
      eyes.squared_tube[q] = eyes_[q].tube * eyes_[q].tube;
      eyes.squared_vote[q] = eyes_[q].voting;
      eyes.segment[q] = eyes_[q].segment;
    }
    pairs_.each_hit(
        input_.grid(), row, simd::best_joins().apart, eyes,
        [&, from = first](std::uint32_t i, std::uint32_t j) { meet(from, i - from, j); });
    for (std::uint32_t q = 0; q < count; ++q) vote(first + q, others_[q], votes);
  }

  /// Copies of what a point needs to look at others, so that a pair costs few reads of memory.
  struct Eye {
    Vector3f at;
    Vector3f normal;
    float tube;    // to the side, m
    float least;   // height of another segment, m; infinity: none is looked for
    float voting;  // squared reach, m^2; below 0: it has no vote
    std::uint32_t segment;
    bool faces;  // does the normal point to the viewer?
  };

  [[nodiscard]] Eye eye_at(std::uint32_t i) const {
    const float spacing = input_.spacings[i];
    const float voting = kVoteReach * input_.radii[i];
    return {input_.grid().points()[i],
            own_.normals[i],
            kGapTube * spacing,
            viewer_ ? kGapResiduals * own_.residuals[i] : std::numeric_limits<float>::infinity(),
            grown_.confident[i] != 0 ? voting * voting : -1,
            segments_.segment[i],
            viewer_ && own_.normals[i].dot(*viewer_ - input_.grid().points()[i]) > 0};
  }

  void meet(std::uint32_t first, std::uint32_t q, std::uint32_t j) {
    if (j == first + q) return;
    const Eye& eye = eyes_[q];
    const Vector3f offset = input_.grid().points()[j] - eye.at;
    const float squared = offset.squaredNorm();
    if (viewer_ && is_before(eye, j, offset, squared)) grown_.hidden[first + q] = 1;
    const bool votes_on = squared <= eye.voting && segments_.segment[j] != eye.segment &&
                          segments_.segment[j] != SurfacePoints::Segments::kNone;
    if (votes_on) others_[q].push_back({squared, j});
  }

  /// Does j belong to a segment between the point and the viewer?
  [[nodiscard]] bool is_before(const Eye& eye, std::uint32_t j, const Vector3f& offset,
                               float squared) const {
    const float height = eye.normal.dot(offset);
    const float off = std::abs(height);
    if (off <= eye.least || (height > 0) != eye.faces) return false;
    const float aside = std::max(0.f, squared - height * height);
    if (aside > eye.tube * eye.tube || off < kGapSlope * std::sqrt(aside)) return false;
    return std::abs(eye.normal.dot(own_.normals[j])) >= kGapCosine;
  }

  /// The nearest points of the nearest other segments.
  void vote(std::uint32_t i, std::vector<std::pair<float, std::uint32_t>>& others,
            std::vector<SignedEdge>& votes) {
    std::sort(others.begin(), others.end());
    std::array<std::pair<std::uint32_t, int>, kVoteSegments> voted{};
    std::size_t count = 0;
    for (const auto& [squared, j] : others) {
      const std::uint32_t segment = segments_.segment[j];
      std::size_t k = 0;
      while (k < count && voted[k].first != segment) ++k;
      if (k == kVoteSegments) continue;
      if (k == count) voted[count++] = {segment, 0};
      if (voted[k].second++ >= kVotesEach) continue;
      const Vector3f offset = input_.grid().points()[j] - input_.grid().points()[i];
      const double a =
          agreement(own_.normals[i], own_.normals[j], offset, segment_tolerance(input_, i, j));
      votes.push_back({segments_.segment[i], segment, EdgeWeight(a * std::abs(a))});
    }
  }

  const SegmentInput& input_;
  const PointFits& own_;
  const std::optional<Vector3f>& viewer_;
  const float reach_ = look_reach(viewer_.has_value());  // R
  GrownSegments& grown_;
  const SurfacePoints::Segments& segments_;
  detail::NearPairs pairs_;
  std::array<Eye, simd::kQueries> eyes_;
  std::array<std::vector<std::pair<float, std::uint32_t>>, simd::kQueries> others_;
};

}  // namespace

float look_reach(bool seen) {
  return seen ? kGapReach : kVoteReach;
}

std::vector<SignedEdge> look_around(const SegmentInput& input, const PointFits& own,
                                    const std::optional<Vector3f>& eye, GrownSegments& grown) {
  if (eye) grown.hidden.assign(input.grid().size(), 0);
  std::vector<std::vector<SignedEdge>> votes(input.graph.blocks());
  input.graph.for_each_block<std::optional<Outlook>>([&](const auto& rows, auto& outlook) {
    if (!outlook) outlook.emplace(input, own, eye, grown);
    outlook->look(rows, votes[rows.number()]);
  });
  std::vector<SignedEdge> all;
  for (const auto& some : votes) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace palpate
