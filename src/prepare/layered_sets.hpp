// Sets of points that may not become one where they lie over each other.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

#include "geometry/signed_sets.hpp"

namespace palpate {

/// Joins sets of points, but not those that lie over each other with normals that agree: the two
/// sides of a blade continue each other at its edge, where they are too near to be told apart, but
/// are not one sheet. Sets are joined once more pairs of their points have asked for it than lie
/// over each other.
class LayeredSets {
 public:
  explicit LayeredSets(detail::SignedSets& sets) : sets_(sets) {}

  /// Notes that i and j lie over each other, whose normals have this sign relative to each other.
  /// Before the first join.
  void add_layers(std::uint32_t i, std::uint32_t j, int sign);

  /// Joins the sets of i and j so that these have this sign, if nothing stands against it.
  void join(std::uint32_t i, std::uint32_t j, int sign);

 private:
  /// Pairs of points of two sets, by the sign that one set has relative to the other then.
  struct Pairs {
    std::array<int, 2> layers{};
    std::array<int, 2> asked{};
  };
  using PairsWith = std::map<std::uint32_t, Pairs>;

  [[nodiscard]] std::uint32_t slot_of(std::uint32_t root) const;
  [[nodiscard]] bool is_refused(std::uint32_t slot_a, std::uint32_t slot_b, int sign);
  void merge(std::uint32_t kept, std::uint32_t gone, int sign);

  detail::SignedSets& sets_;
  // What a set says is kept at one of its points, its slot, and relative to that point's sign: the
  // root, or what stands here.
  std::unordered_map<std::uint32_t, std::uint32_t> slots_;
  std::unordered_map<std::uint32_t, PairsWith> said_;  // by slots, in both directions
};

}  // namespace palpate
