#include "geometry/signed_forest.hpp"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate::detail {
namespace {

// Disjoint sets whose members know their sign relative to their set's root.
class SignedSets {
 public:
  explicit SignedSets(std::uint32_t count) : parent_(count), sign_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  // The root of i's set and i's sign relative to it. Shortens the way for the next time.
  std::pair<std::uint32_t, float> find(std::uint32_t i) {
    std::uint32_t root = i;
    float sign = 1;
    for (; parent_[root] != root; root = parent_[root]) sign *= sign_[root];
    const float sign_of_i = sign;
    while (parent_[i] != root && i != root) {
      const std::uint32_t next = std::exchange(parent_[i], root);
      const float sign_to_next = std::exchange(sign_[i], sign);
      sign *= sign_to_next;
      i = next;
    }
    return {root, sign_of_i};
  }

  // Joins two sets so that members a and b have this sign relative to each other.
  void join(std::uint32_t a, std::uint32_t b, float sign) {
    const auto [root_a, sign_a] = find(a);
    const auto [root_b, sign_b] = find(b);
    if (root_a == root_b) return;
    const auto [low, high] = std::minmax(root_a, root_b);
    parent_[high] = low;
    sign_[high] = sign * sign_a * sign_b;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<float> sign_;
};

// Names parts by their roots and adds up the votes between the same two.
void contract(SignedSets& sets, std::vector<Vote>& votes) {
  std::size_t kept = 0;
  for (const Vote& vote : votes) {
    const auto [a, sign_a] = sets.find(vote.a);
    const auto [b, sign_b] = sets.find(vote.b);
    if (a == b) continue;
    votes[kept++] = {std::min(a, b), std::max(a, b), vote.value * sign_a * sign_b};
  }
  votes.resize(kept);
  // Values take part in the order so that equal pairs are always added in the same order.
  tbb::parallel_sort(votes.begin(), votes.end(), [](const Vote& x, const Vote& y) {
    if (x.a != y.a) return x.a < y.a;
    return x.b != y.b ? x.b < y.b : x.value < y.value;
  });
  kept = 0;
  for (const Vote& vote : votes) {
    if (kept > 0 && votes[kept - 1].a == vote.a && votes[kept - 1].b == vote.b) {
      votes[kept - 1].value += vote.value;
    } else {
      votes[kept++] = vote;
    }
  }
  votes.resize(kept);
}

bool surer(const Vote& x, const Vote& y) {
  const float size_x = std::abs(x.value);
  const float size_y = std::abs(y.value);
  if (size_x != size_y) return size_x > size_y;
  return std::pair(x.a, x.b) < std::pair(y.a, y.b);
}

// Each part's surest vote is followed.
void merge_round(const std::vector<Vote>& votes, std::uint32_t patches, SignedSets& sets) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> best(patches, kNone);
  for (std::uint32_t v = 0; v < votes.size(); ++v) {
    for (const std::uint32_t part : {votes[v].a, votes[v].b}) {
      if (best[part] == kNone || surer(votes[v], votes[best[part]])) best[part] = v;
    }
  }
  for (const std::uint32_t v : best) {
    if (v == kNone) continue;
    sets.join(votes[v].a, votes[v].b, votes[v].value < 0 ? -1.f : 1.f);
  }
}

}  // namespace

SignedParts merge_by_votes(std::uint32_t patches, std::vector<Vote> votes) {
  SignedSets sets(patches);
  for (contract(sets, votes); !votes.empty(); contract(sets, votes)) {
    merge_round(votes, patches, sets);
  }
  SignedParts parts;
  parts.part.resize(patches);
  parts.sign.resize(patches);
  for (std::uint32_t i = 0; i < patches; ++i) {
    const auto [root, sign] = sets.find(i);
    parts.part[i] = root == i ? parts.count++ : parts.part[root];  // roots come first
    parts.sign[i] = sign;
  }
  return parts;
}

}  // namespace palpate::detail
