// Signed edges between segments, and the clusters that segments with agreeing signs make.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "geometry/signed_sets.hpp"
#include "refine/cluster_edges.hpp"

namespace palpate {

/// The votes of pairs of points between two segments, or two clusters of them, on their relative
/// sign.
struct VoteSum {
  double value = 0;    ///< sum of v |v| over the votes v
  double squares = 0;  ///< sum of v^2

  /// 1, -1, or 0: they disagree, or there are hardly any.
  [[nodiscard]] int sign() const;
  [[nodiscard]] VoteSum turned(int sign) const { return {sign * value, squares}; }
  VoteSum& operator+=(const VoteSum& other);
};

struct SignedEdge {
  std::uint32_t a = 0;  ///< segments, a < b
  std::uint32_t b = 0;
  VoteSum votes;
};

/// Clusters of segments, which are joined as a whole: by the votes of all pairs between them. Two
/// segments may agree by chance where few points meet, such as those of a box and of the floor
/// below it, which goes on beneath.
class SegmentClusters {
 public:
  /// `edges`: one for each pair of segments at most.
  SegmentClusters(std::span<const SignedEdge> edges, std::size_t segments);

  /// The root of the segment's cluster, its lowest segment, and the segment's sign relative to it.
  [[nodiscard]] std::pair<std::uint32_t, int> find(std::uint32_t segment) {
    return sets_.find(segment);
  }

  /// The sign of one root relative to the other by the votes between their clusters; 0: they are
  /// one cluster, or the votes do not decide it.
  [[nodiscard]] int sign_between(std::uint32_t root_a, std::uint32_t root_b) const;

  /// Joins the clusters of two different roots; `sign`: 1 or -1.
  void join(std::uint32_t root_a, std::uint32_t root_b, int sign);

 private:
  detail::SignedSets sets_;
  ClusterEdges<VoteSum> edges_;
};

}  // namespace palpate
