#include "viewer/thinned.hpp"

#include <algorithm>
#include <numeric>

namespace palpate::viewer {
namespace {

// A place in a stretch that repeats from call to call and has no rhythm that a scan's rows could
// have, too.
std::uint64_t scattered(std::uint64_t i) {
  std::uint64_t x = (i + 1) * 0x9E3779B97F4A7C15u;
  x ^= x >> 31;
  x *= 0xBF58476D1CE4E5B9u;
  return x ^ (x >> 29);
}

}  // namespace

std::vector<std::uint32_t> thinned(std::size_t count, std::size_t budget) {
  std::vector<std::uint32_t> kept(std::min(count, budget));
  if (kept.size() == count) {
    std::iota(kept.begin(), kept.end(), 0u);
    return kept;
  }
  for (std::size_t i = 0; i < budget; ++i) {
    const std::size_t begin = i * count / budget;
    const std::size_t end = (i + 1) * count / budget;
    kept[i] = static_cast<std::uint32_t>(begin + scattered(i) % (end - begin));
  }
  return kept;
}

std::vector<std::size_t> shares(const std::vector<std::size_t>& sizes, std::size_t budget) {
  const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  if (all <= budget) return sizes;
  std::vector<std::size_t> parts;
  for (const std::size_t size : sizes) parts.push_back(size * budget / all);
  return parts;
}

}  // namespace palpate::viewer
