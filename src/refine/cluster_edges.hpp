// Weights of the edges between clusters while these are joined.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate {

/// A graph of clusters: the weight of an edge is the sum over pairs of members of its two clusters,
/// relative to the signs of their roots (detail::SignedSets). Joining two clusters adds up their
/// edges, as greedy additive edge contraction does (Keuper et al., 2015). `Weight`: has +=, and
/// turned(sign): the same where one of the two has turned.
template <class Weight>
class ClusterEdges {
 public:
  explicit ClusterEdges(std::size_t count) : slots_(count), turns_(count, 1), edges_(count) {
    std::iota(slots_.begin(), slots_.end(), 0u);
  }

  /// Adds to the weight of the edge between the clusters of two different roots.
  void add(std::uint32_t root_a, std::uint32_t root_b, const Weight& weight) {
    const std::uint32_t a = slots_[root_a];
    const std::uint32_t b = slots_[root_b];
    const Weight of_slots = weight.turned(turns_[a] * turns_[b]);
    edges_[a][b] += of_slots;
    edges_[b][a] += of_slots;
  }

  /// The weight of the edge between the clusters of two different roots; Weight(): there is none.
  [[nodiscard]] Weight between(std::uint32_t root_a, std::uint32_t root_b) const {
    const std::uint32_t a = slots_[root_a];
    const std::uint32_t b = slots_[root_b];
    const auto weight = edges_[a].find(b);
    return weight == edges_[a].end() ? Weight() : weight->second.turned(turns_[a] * turns_[b]);
  }

  /// The clusters of two different roots become one with the lower root; `sign`: of one root
  /// relative to the other, 1 or -1.
  void join(std::uint32_t root_a, std::uint32_t root_b, int sign) {
    std::uint32_t kept = slots_[root_a];
    std::uint32_t gone = slots_[root_b];
    if (edges_[kept].size() < edges_[gone].size()) std::swap(kept, gone);  // so that few move
    const int turn = sign * turns_[kept] * turns_[gone];
    for (const auto& [other, weight] : edges_[gone]) {
      edges_[other].erase(gone);
      if (other == kept) continue;
      const Weight turned = weight.turned(turn);
      edges_[kept][other] += turned;
      edges_[other][kept] += turned;
    }
    edges_[gone].clear();
    const std::uint32_t root = std::min(root_a, root_b);
    if (slots_[root] == gone) turns_[kept] *= sign;
    slots_[root] = kept;
  }

 private:
  std::vector<std::uint32_t> slots_;  // where the cluster of a root keeps its edges
  std::vector<int> turns_;            // a slot's sign relative to its cluster's root
  std::vector<std::map<std::uint32_t, Weight>> edges_;  // of a slot, by the other slot
};

}  // namespace palpate
