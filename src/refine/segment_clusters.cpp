// Joins clusters of segments along signed edges.

#include "refine/segment_clusters.hpp"

#include <cmath>

namespace palpate {

int VoteSum::sign() const {
  constexpr double kAgreeing = 0.7;  // |sum v|v|| over sum v^2: 17 of 20 agree; judgement
  constexpr double kEnough = 0.3;    // sum v^2 of the votes v; less is chance; judgement
  if (!(squares > kEnough) || !(std::abs(value) >= kAgreeing * squares)) return 0;
  return value < 0 ? -1 : 1;
}

VoteSum& VoteSum::operator+=(const VoteSum& other) {
  value += other.value;
  squares += other.squares;
  return *this;
}

SegmentClusters::SegmentClusters(std::span<const SignedEdge> edges, std::size_t segments)
    : sets_(segments), edges_(segments) {
  for (const SignedEdge& edge : edges) edges_.add(edge.a, edge.b, edge.votes);
}

int SegmentClusters::sign_between(std::uint32_t root_a, std::uint32_t root_b) const {
  return root_a == root_b ? 0 : edges_.between(root_a, root_b).sign();
}

void SegmentClusters::join(std::uint32_t root_a, std::uint32_t root_b, int sign) {
  edges_.join(root_a, root_b, sign);
  sets_.join(root_a, root_b, sign);
}

}  // namespace palpate
