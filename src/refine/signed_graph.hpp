// A graph with signed edges, and its contraction along those that agree.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "geometry/signed_sets.hpp"

namespace palpate {

// |sum| over the sum of sizes of weights that decide: three quarters agree; judgement.
inline constexpr double kCoherent = 0.5;

/// What speaks for one relative sign of two nodes' normals: the same (> 0) or the other (< 0).
struct EdgeWeight {
  double sum = 0;
  double size = 0;  ///< sum of the absolute values

  EdgeWeight() = default;
  explicit EdgeWeight(double weight);
  /// Speaks against this sign as much as a weight of 1 for it, and for no other.
  [[nodiscard]] static EdgeWeight cannot_link(int sign);

  /// The sign that at least (1 + share) / 2 of the weights have; 0: neither, or there is none.
  [[nodiscard]] int sign(double share) const;
  [[nodiscard]] EdgeWeight turned(int sign) const;
  EdgeWeight& operator+=(const EdgeWeight& other);
};

struct SignedEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  EdgeWeight weight;
};

/// Clusters of nodes, which have a sign each, and what speaks for joining them. Contraction makes
/// one of the two clusters that gain the most by it, |sum| less kCoherent times the size, adds up
/// their edges to others, and goes on while anything is gained (greedy additive edge contraction:
/// Keuper et al., Efficient decomposition of image and mesh graphs by lifted multicuts, 2015). So
/// clusters agree as a whole: where few points meet, two may agree by chance, such as a box and the
/// floor below it, which goes on beneath.
class SignedGraph {
 public:
  /// `clusters`: nodes that are one before. The last node stands for the free side: what is known
  /// of a node's side is an edge to it, and none is joined with it.
  explicit SignedGraph(detail::SignedSets clusters);

  /// The root of a node's cluster, which is any node of it, and the node's sign relative to it.
  [[nodiscard]] std::pair<std::uint32_t, int> find(std::uint32_t node) { return sets_.find(node); }

  /// Adds to what there is between the clusters of two nodes.
  void add(const SignedEdge& edge);

  /// What is known of the side of a node's cluster, relative to the node.
  [[nodiscard]] EdgeWeight side(std::uint32_t node);

  /// Joins clusters until none gain. Two stay apart where the sides of both are known and
  /// contradict what is between them.
  void contract();

 private:
  using Edges = std::map<std::uint32_t, EdgeWeight>;

  /// Makes one of the clusters of two roots. @return those of its edges that this changed
  Edges join(std::uint32_t a, std::uint32_t b, int sign);

  detail::SignedSets sets_;
  std::vector<Edges> edges_;  // of a root, by the other root
  std::uint32_t free_side_;
};

}  // namespace palpate
