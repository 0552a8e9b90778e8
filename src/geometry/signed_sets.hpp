// Disjoint sets, to find what hangs together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate::detail {

/// Disjoint sets whose members have a sign relative to their set's root: its lowest member where
/// join() alone was called. Threads may use one object together as long as each keeps to members of
/// its own.
class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parent_(count), sign_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  /// The root of i's set and i's sign relative to it. Compresses the path for the next time.
  std::pair<std::uint32_t, int> find(std::uint32_t i) {
    std::uint32_t root = i;
    int sign = 1;
    for (; parent_[root] != root; root = parent_[root]) sign *= sign_[root];
    const int sign_of_i = sign;
    while (parent_[i] != root && i != root) {
      const std::uint32_t next = std::exchange(parent_[i], root);
      const int sign_to_next = std::exchange(sign_[i], static_cast<std::int8_t>(sign));
      sign *= sign_to_next;
      i = next;
    }
    return {root, sign_of_i};
  }

  /// Joins the sets of a and b so that these have this sign relative to each other.
  void join(std::uint32_t a, std::uint32_t b, int sign) {
    const auto [root_a, sign_a] = find(a);
    const auto [root_b, sign_b] = find(b);
    if (root_a == root_b) return;
    const auto [low, high] = std::minmax(root_a, root_b);
    attach(high, low, sign * sign_a * sign_b);
  }

  /// Joins the sets of two different roots, of which the second becomes that of both.
  void attach(std::uint32_t root, std::uint32_t to, int sign) {
    parent_[root] = to;
    sign_[root] = static_cast<std::int8_t>(sign);
  }

  [[nodiscard]] std::size_t size() const { return parent_.size(); }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::int8_t> sign_;
};

}  // namespace palpate::detail
