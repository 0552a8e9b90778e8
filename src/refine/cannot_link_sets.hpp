// Clusters of points under cannot-link constraints: stacked surfaces stay apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "geometry/signed_sets.hpp"
#include "refine/cluster_edges.hpp"

namespace palpate {

/// Joins sets of points, but not those that lie over each other with normals that agree: the two
/// sides of a blade continue each other at its edge, where they are too near to be separated, but
/// are not one segment. Each pair of points that lie over each other is a cannot-link constraint
/// between their sets. Sets are joined once more pairs have voted for it than constrain it.
class CannotLinkSets {
 public:
  /// `sets`: of so many points.
  CannotLinkSets(detail::SignedSets& sets, std::size_t count) : sets_(sets), constraints_(count) {}

  /// Adds the constraint that i and j lie over each other; `sign`: of one's normal relative to the
  /// other's.
  void add_cannot_link(std::uint32_t i, std::uint32_t j, int sign);

  /// Joins the sets of i and j so that these have this sign, if no constraint is left between them.
  void join(std::uint32_t i, std::uint32_t j, int sign);

 private:
  /// How many more pairs lie over each other than have voted to join, for either sign of one root
  /// relative to the other: -1, 1.
  struct Constraints {
    std::array<int, 2> pairs{};

    [[nodiscard]] int& of(int sign) { return pairs[sign > 0 ? 1 : 0]; }
    [[nodiscard]] Constraints turned(int sign) const;
    Constraints& operator+=(const Constraints& other);
  };

  void count(std::uint32_t root_i, std::uint32_t root_j, int sign, int pairs);

  detail::SignedSets& sets_;
  ClusterEdges<Constraints> constraints_;
};

}  // namespace palpate
