#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpate::app {

/// By nearest rank: the smallest of `sorted` that a share (0 to 1) of them is no larger than; 0 of
/// none.
template <class Number>
[[nodiscard]] double quantile(const std::vector<Number>& sorted, double share) {
  if (sorted.empty()) return 0;
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return static_cast<double>(sorted[std::max<std::size_t>(rank, 1) - 1]);
}

}  // namespace palpate::app
