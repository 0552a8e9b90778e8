// What sheets say of each other's signs, and the sets that those make which agree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "geometry/signed_sets.hpp"
#include "refine/said_by_sets.hpp"

namespace palpate {

/// What the pairs of points between two sheets, or two sets of them, say of their relative sign.
struct Said {
  double value = 0;    ///< sum of v |v| over the votes v
  double squares = 0;  ///< sum of v^2

  /// 1, -1, or 0: they disagree, or there are hardly any.
  [[nodiscard]] int sign() const;
  [[nodiscard]] Said turned(int sign) const { return {sign * value, squares}; }
  Said& operator+=(const Said& other);
};

struct Bond {
  std::uint32_t a = 0;  ///< sheets, a < b
  std::uint32_t b = 0;
  Said said;
};

/// Sets of sheets, which are joined as a whole: by all that their points say of each other. Two of
/// their sheets may agree by chance where few points meet, such as those of a box and of the floor
/// below it, which goes on beneath.
class BondedSets {
 public:
  /// `bonds`: one for each pair of sheets at most.
  BondedSets(std::span<const Bond> bonds, std::size_t sheets);

  /// The root of the sheet's set, its lowest sheet, and the sheet's sign relative to it.
  [[nodiscard]] std::pair<std::uint32_t, int> find(std::uint32_t sheet) {
    return sets_.find(sheet);
  }

  /// The sign of one root relative to the other, as their sets say; 0: they are one, or say
  /// nothing.
  [[nodiscard]] int sign_between(std::uint32_t root_a, std::uint32_t root_b) const;

  /// Joins the sets of two different roots; `sign`: 1 or -1.
  void join(std::uint32_t root_a, std::uint32_t root_b, int sign);

 private:
  detail::SignedSets sets_;
  SaidBySets<Said> said_;
};

}  // namespace palpate
