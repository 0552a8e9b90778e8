// Joins sets of sheets by what they say of each other.

#include "refine/bonds.hpp"

#include <cmath>

namespace palpate {

int Said::sign() const {
  constexpr double kAgreeing = 0.7;  // |sum v|v|| over sum v^2: 17 of 20 agree; judgement
  constexpr double kEnough = 0.3;    // sum v^2 of the votes v; less is chance; judgement
  if (!(squares > kEnough) || !(std::abs(value) >= kAgreeing * squares)) return 0;
  return value < 0 ? -1 : 1;
}

Said& Said::operator+=(const Said& other) {
  value += other.value;
  squares += other.squares;
  return *this;
}

BondedSets::BondedSets(std::span<const Bond> bonds, std::size_t sheets)
    : sets_(sheets), said_(sheets) {
  for (const Bond& bond : bonds) said_.add(bond.a, bond.b, bond.said);
}

int BondedSets::sign_between(std::uint32_t root_a, std::uint32_t root_b) const {
  return root_a == root_b ? 0 : said_.between(root_a, root_b).sign();
}

void BondedSets::join(std::uint32_t root_a, std::uint32_t root_b, int sign) {
  said_.join(root_a, root_b, sign);
  sets_.join(root_a, root_b, sign);
}

}  // namespace palpate
