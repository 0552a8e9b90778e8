// Contracts a graph with signed edges.

#include "refine/signed_graph.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace palpate {
namespace {

double gain_of(const EdgeWeight& weight) {
  return std::abs(weight.sum) - kCoherent * weight.size;
}

/// Two roots, and what joining them gained when they were queued.
struct Candidate {
  double gain;
  std::uint32_t a;  // < b
  std::uint32_t b;

  bool operator<(const Candidate& other) const {
    return gain != other.gain ? gain < other.gain : std::pair(a, b) > std::pair(other.a, other.b);
  }
};

}  // namespace

EdgeWeight::EdgeWeight(double weight) : sum(weight), size(std::abs(weight)) {}

EdgeWeight EdgeWeight::cannot_link(int sign) {
  constexpr double kGain = 1 - kCoherent;  // of a weight of 1
  EdgeWeight result;
  result.sum = -0.5 * kGain * sign;
  result.size = 0.5 * kGain / kCoherent;
  return result;
}

int EdgeWeight::sign(double share) const {
  if (!(size > 0) || std::abs(sum) < share * size) return 0;
  return sum < 0 ? -1 : 1;
}

EdgeWeight EdgeWeight::turned(int sign) const {
  EdgeWeight result = *this;
  result.sum *= sign;
  return result;
}

EdgeWeight& EdgeWeight::operator+=(const EdgeWeight& other) {
  sum += other.sum;
  size += other.size;
  return *this;
}

SignedGraph::SignedGraph(detail::SignedSets clusters)
    : sets_(std::move(clusters)),
      edges_(sets_.size()),
      free_side_(static_cast<std::uint32_t>(sets_.size()) - 1) {}

void SignedGraph::add(const SignedEdge& edge) {
  const auto [a, sign_a] = find(edge.a);
  const auto [b, sign_b] = find(edge.b);
  if (a == b) return;
  const EdgeWeight of_roots = edge.weight.turned(sign_a * sign_b);
  edges_[a][b] += of_roots;
  edges_[b][a] += of_roots;
}

EdgeWeight SignedGraph::side(std::uint32_t node) {
  const auto [root, sign] = find(node);
  const auto edge = edges_[root].find(free_side_);
  return edge == edges_[root].end() ? EdgeWeight() : edge->second.turned(sign);
}

void SignedGraph::contract() {
  std::priority_queue<Candidate> queue;
  const auto offer = [&](std::uint32_t a, std::uint32_t b, const EdgeWeight& weight) {
    const double gain = gain_of(weight);
    if (gain > 0 && b != free_side_) queue.push({gain, std::min(a, b), std::max(a, b)});
  };
  for (std::uint32_t a = 0; a < free_side_; ++a) {
    for (const auto& [b, weight] : edges_[a]) {
      if (a < b) offer(a, b, weight);
    }
  }
  while (!queue.empty()) {
    const auto [gain, a, b] = queue.top();
    queue.pop();
    const auto edge = edges_[a].find(b);
    if (edge == edges_[a].end() || gain_of(edge->second) != gain) continue;  // not any more
    const int sign = edge->second.sum < 0 ? -1 : 1;
    const int side_a = side(a).sign(kCoherent);
    const int side_b = side(b).sign(kCoherent);
    if (side_a * side_b == -sign) continue;
    const Edges changed = join(a, b, sign);
    const std::uint32_t root = find(a).first;
    // What its side kept apart may be joined now that it has another.
    const int before = root == a ? side_a : side_b;
    const bool freed = before != 0 && side(root).sign(kCoherent) != before;
    for (const auto& [other, weight] : freed ? edges_[root] : changed) offer(root, other, weight);
  }
}

SignedGraph::Edges SignedGraph::join(std::uint32_t a, std::uint32_t b, int sign) {
  const auto [gone, kept] = edges_[a].size() < edges_[b].size() ? std::pair(a, b) : std::pair(b, a);
  edges_[kept].erase(gone);
  edges_[gone].erase(kept);
  Edges changed = std::exchange(edges_[gone], {});
  for (auto& [other, weight] : changed) {
    weight = edges_[kept][other] += weight.turned(sign);
    edges_[other].erase(gone);
    edges_[other][kept] = weight;
  }
  sets_.attach(gone, kept, sign);
  return changed;
}

}  // namespace palpate
