// Counts cannot-link pairs between two sets of points, less the pairs that vote to join them.

#include "refine/cannot_link_sets.hpp"

namespace palpate {

CannotLinkSets::Constraints CannotLinkSets::Constraints::turned(int sign) const {
  return sign > 0 ? *this : Constraints{{pairs[1], pairs[0]}};
}

CannotLinkSets::Constraints& CannotLinkSets::Constraints::operator+=(const Constraints& other) {
  for (const std::size_t k : {0, 1}) pairs[k] += other.pairs[k];
  return *this;
}

void CannotLinkSets::count(std::uint32_t root_i, std::uint32_t root_j, int sign, int pairs) {
  Constraints change;
  change.of(sign) = pairs;
  constraints_.add(root_i, root_j, change);
}

void CannotLinkSets::add_cannot_link(std::uint32_t i, std::uint32_t j, int sign) {
  const auto [root_i, sign_i] = sets_.find(i);
  const auto [root_j, sign_j] = sets_.find(j);
  if (root_i != root_j) count(root_i, root_j, sign * sign_i * sign_j, 1);
}

void CannotLinkSets::join(std::uint32_t i, std::uint32_t j, int sign) {
  const auto [root_i, sign_i] = sets_.find(i);
  const auto [root_j, sign_j] = sets_.find(j);
  if (root_i == root_j) return;
  const int of_roots = sign * sign_i * sign_j;
  if (constraints_.between(root_i, root_j).of(of_roots) > 0) {
    count(root_i, root_j, of_roots, -1);
    return;
  }
  sets_.join(i, j, sign);
  constraints_.join(root_i, root_j, of_roots);
}

}  // namespace palpate
