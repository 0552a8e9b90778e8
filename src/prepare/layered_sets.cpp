// Counts pairs of points that keep two sets apart, and those that ask to join them.

#include "prepare/layered_sets.hpp"

#include <algorithm>

namespace palpate {

void LayeredSets::add_layers(std::uint32_t i, std::uint32_t j, int sign) {
  const auto [root_i, sign_i] = sets_.find(i);
  const auto [root_j, sign_j] = sets_.find(j);
  if (root_i == root_j) return;
  const std::size_t k = sign * sign_i * sign_j > 0 ? 1 : 0;
  ++said_[root_i][root_j].layers[k];
  ++said_[root_j][root_i].layers[k];
}

void LayeredSets::join(std::uint32_t i, std::uint32_t j, int sign) {
  const auto [root_i, sign_i] = sets_.find(i);
  const auto [root_j, sign_j] = sets_.find(j);
  if (root_i == root_j) return;
  const std::uint32_t slot_i = slot_of(root_i);
  const std::uint32_t slot_j = slot_of(root_j);
  const int of_slots =
      sign * sign_i * sign_j * sets_.find(slot_i).second * sets_.find(slot_j).second;
  const bool i_says = said_.contains(slot_i);
  const bool j_says = said_.contains(slot_j);
  if (i_says && j_says && is_refused(slot_i, slot_j, of_slots)) return;
  sets_.join(i, j, sign);
  if (!i_says && !j_says) return;
  const bool i_stays = !j_says || (i_says && said_[slot_i].size() >= said_[slot_j].size());
  slots_[std::min(root_i, root_j)] = i_stays ? slot_i : slot_j;
  if (i_says && j_says) {
    merge(i_stays ? slot_i : slot_j, i_stays ? slot_j : slot_i, of_slots);
  }
}

std::uint32_t LayeredSets::slot_of(std::uint32_t root) const {
  const auto slot = slots_.find(root);
  return slot == slots_.end() ? root : slot->second;
}

/// Counts that a pair has asked.
bool LayeredSets::is_refused(std::uint32_t slot_a, std::uint32_t slot_b, int sign) {
  const auto pairs = said_[slot_a].find(slot_b);
  if (pairs == said_[slot_a].end()) return false;
  const std::size_t k = sign > 0 ? 1 : 0;
  ++pairs->second.asked[k];
  ++said_[slot_b][slot_a].asked[k];
  return pairs->second.asked[k] <= pairs->second.layers[k];
}

/// `sign`: of `gone` relative to `kept`.
void LayeredSets::merge(std::uint32_t kept, std::uint32_t gone, int sign) {
  for (const auto& [other, pairs] : said_[gone]) {
    said_[other].erase(gone);
    if (other == kept) continue;
    for (Pairs* sum : {&said_[kept][other], &said_[other][kept]}) {
      for (const std::size_t k : {0, 1}) {
        const std::size_t to = sign > 0 ? k : 1 - k;
        sum->layers[to] += pairs.layers[k];
        sum->asked[to] += pairs.asked[k];
      }
    }
  }
  said_.erase(gone);
}

}  // namespace palpate
