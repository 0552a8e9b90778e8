// Counts pairs of points that keep two sets apart, less those that ask to join them.

#include "refine/layered_sets.hpp"

namespace palpate {

LayeredSets::Against LayeredSets::Against::turned(int sign) const {
  return sign > 0 ? *this : Against{{pairs[1], pairs[0]}};
}

LayeredSets::Against& LayeredSets::Against::operator+=(const Against& other) {
  for (const std::size_t k : {0, 1}) pairs[k] += other.pairs[k];
  return *this;
}

void LayeredSets::count(std::uint32_t root_i, std::uint32_t root_j, int sign, int pairs) {
  Against against;
  against.of(sign) = pairs;
  against_.add(root_i, root_j, against);
}

void LayeredSets::add_layers(std::uint32_t i, std::uint32_t j, int sign) {
  const auto [root_i, sign_i] = sets_.find(i);
  const auto [root_j, sign_j] = sets_.find(j);
  if (root_i != root_j) count(root_i, root_j, sign * sign_i * sign_j, 1);
}

void LayeredSets::join(std::uint32_t i, std::uint32_t j, int sign) {
  const auto [root_i, sign_i] = sets_.find(i);
  const auto [root_j, sign_j] = sets_.find(j);
  if (root_i == root_j) return;
  const int of_roots = sign * sign_i * sign_j;
  if (against_.between(root_i, root_j).of(of_roots) > 0) {
    count(root_i, root_j, of_roots, -1);
    return;
  }
  sets_.join(i, j, sign);
  against_.join(root_i, root_j, of_roots);
}

}  // namespace palpate
