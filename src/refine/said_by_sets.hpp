// What sets say of each other, while they are joined.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate {

/// Sums up what the members of sets say of those of other sets, relative to the signs of the sets'
/// roots (detail::SignedSets). `Said`: has +=, and turned(sign): the same where one of the two has
/// turned.
template <class Said>
class SaidBySets {
 public:
  explicit SaidBySets(std::size_t count) : slots_(count), turns_(count, 1), said_(count) {
    std::iota(slots_.begin(), slots_.end(), 0u);
  }

  /// Adds to what the sets of two different roots say of each other.
  void add(std::uint32_t root_a, std::uint32_t root_b, const Said& said) {
    const std::uint32_t a = slots_[root_a];
    const std::uint32_t b = slots_[root_b];
    const Said of_slots = said.turned(turns_[a] * turns_[b]);
    said_[a][b] += of_slots;
    said_[b][a] += of_slots;
  }

  /// What the sets of two different roots say of each other; Said(): nothing.
  [[nodiscard]] Said between(std::uint32_t root_a, std::uint32_t root_b) const {
    const std::uint32_t a = slots_[root_a];
    const std::uint32_t b = slots_[root_b];
    const auto said = said_[a].find(b);
    return said == said_[a].end() ? Said() : said->second.turned(turns_[a] * turns_[b]);
  }

  /// The sets of two different roots become one with the lower root; `sign`: of one root relative
  /// to the other, 1 or -1.
  void join(std::uint32_t root_a, std::uint32_t root_b, int sign) {
    std::uint32_t kept = slots_[root_a];
    std::uint32_t gone = slots_[root_b];
    if (said_[kept].size() < said_[gone].size()) std::swap(kept, gone);  // so that few move
    const int turn = sign * turns_[kept] * turns_[gone];
    for (const auto& [other, said] : said_[gone]) {
      said_[other].erase(gone);
      if (other == kept) continue;
      const Said turned = said.turned(turn);
      said_[kept][other] += turned;
      said_[other][kept] += turned;
    }
    said_[gone].clear();
    const std::uint32_t root = std::min(root_a, root_b);
    if (slots_[root] == gone) turns_[kept] *= sign;
    slots_[root] = kept;
  }

 private:
  std::vector<std::uint32_t> slots_;                 // where the set of a root keeps what it says
  std::vector<int> turns_;                           // a slot's sign relative to its set's root
  std::vector<std::map<std::uint32_t, Said>> said_;  // what a slot says of other slots
};

}  // namespace palpate
