// Sets of points that may not become one where they lie over each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "geometry/signed_sets.hpp"
#include "refine/cluster_edges.hpp"

namespace palpate {

/// Joins sets of points, but not those that lie over each other with normals that agree: the two
/// sides of a blade continue each other at its edge, where they are too near to be told apart, but
/// are not one sheet. Sets are joined once more pairs of their points have asked for it than lie
/// over each other.
class LayeredSets {
 public:
  /// `sets`: of so many points.
  LayeredSets(detail::SignedSets& sets, std::size_t count) : sets_(sets), against_(count) {}

  /// Notes that i and j lie over each other, whose normals have this sign relative to each other.
  void add_layers(std::uint32_t i, std::uint32_t j, int sign);

  /// Joins the sets of i and j so that these have this sign, if nothing stands against it.
  void join(std::uint32_t i, std::uint32_t j, int sign);

 private:
  /// How many more pairs lie over each other than have asked, by the sign of one root relative to
  /// the other that they speak of: -1, 1.
  struct Against {
    std::array<int, 2> pairs{};

    [[nodiscard]] int& of(int sign) { return pairs[sign > 0 ? 1 : 0]; }
    [[nodiscard]] Against turned(int sign) const;
    Against& operator+=(const Against& other);
  };

  void count(std::uint32_t root_i, std::uint32_t root_j, int sign, int pairs);

  detail::SignedSets& sets_;
  ClusterEdges<Against> against_;
};

}  // namespace palpate
