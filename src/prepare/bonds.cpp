// Joins sets of sheets and sums up what they say of others.

#include "prepare/bonds.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate {

int Said::sign() const {
  constexpr double kAgreeing = 0.7;  // |sum v|v|| over sum v^2: 17 of 20 agree; judgement
  constexpr double kEnough = 0.3;    // sum v^2 of the votes v; less is chance; judgement
  if (!(squares > kEnough) || !(std::abs(value) >= kAgreeing * squares)) return 0;
  return value < 0 ? -1 : 1;
}

BondedSets::BondedSets(std::span<const Bond> bonds, std::size_t sheets)
    : sets_(sheets), slots_(sheets), turns_(sheets, 1), said_(sheets) {
  std::iota(slots_.begin(), slots_.end(), 0u);
  for (const Bond& bond : bonds) {
    said_[bond.a].emplace(bond.b, bond.said);
    said_[bond.b].emplace(bond.a, bond.said);
  }
}

int BondedSets::sign_between(std::uint32_t root_a, std::uint32_t root_b) const {
  if (root_a == root_b) return 0;
  const std::uint32_t a = slots_[root_a];
  const std::uint32_t b = slots_[root_b];
  const auto said = said_[a].find(b);
  return said == said_[a].end() ? 0 : said->second.sign() * turns_[a] * turns_[b];
}

void BondedSets::join(std::uint32_t root_a, std::uint32_t root_b, int sign) {
  std::uint32_t kept = slots_[root_a];
  std::uint32_t gone = slots_[root_b];
  if (said_[kept].size() < said_[gone].size()) std::swap(kept, gone);  // so that few move
  const int turn = sign * turns_[kept] * turns_[gone];
  for (const auto& [other, said] : said_[gone]) {
    said_[other].erase(gone);
    if (other == kept) continue;
    for (Said* sum : {&said_[kept][other], &said_[other][kept]}) {
      sum->value += turn * said.value;
      sum->squares += said.squares;
    }
  }
  said_[gone].clear();
  const std::uint32_t root = std::min(root_a, root_b);
  if (slots_[root] == gone) turns_[kept] *= sign;
  slots_[root] = kept;
  sets_.join(root_a, root_b, sign);
}

}  // namespace palpate
