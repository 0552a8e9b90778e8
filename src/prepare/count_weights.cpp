#include "prepare/count_weights.hpp"

#include <algorithm>

#include "geometry/parallel.hpp"

namespace palpate {
namespace {

constexpr float kLeast = 0.2f;  // a lone point still holds the surface together
constexpr float kMost = 3;

}  // namespace

void weigh_by_counts(const CellGrid& grid, std::span<const std::uint32_t> counts,
                     std::span<const float> radii, std::vector<float>& weights) {
  detail::parallel_ranges(weights.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = begin; i < end; ++i) {
      near.clear();
      grid.within(grid.points()[i], radii[i], near);
      float sum = 0;
      for (const std::uint32_t k : near) sum += static_cast<float>(counts[k]);
      const float mean = near.empty() ? 0 : sum / static_cast<float>(near.size());
      if (!(mean > 0)) continue;
      weights[i] *= std::clamp(static_cast<float>(counts[i]) / mean, kLeast, kMost);
    }
  });
}

}  // namespace palpate
