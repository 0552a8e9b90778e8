#include "prepare/irregularity.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

constexpr std::size_t kSpacingSamples = 1000;
constexpr std::size_t kFewestPoints = 100;  // points that tell
constexpr std::size_t kLooked = 9;          // itself, and others of which some may share its place

// Random points have 0.52; scanners' meshes, frames and jittered grids 0.71 and above.
constexpr double kIrregular = 0.65;

}  // namespace

double nearest_share(const CellGrid& grid, std::span<const float> spacings) {
  if (grid.size() < kFewestPoints) return 1;
  const std::size_t step = std::max<std::size_t>(1, grid.size() / kSpacingSamples);
  std::vector<float> shares;
  std::vector<CellGrid::Neighbor> near;
  for (std::size_t i = step / 2; i < grid.size(); i += step) {
    grid.nearest(grid.points()[i], kLooked, near);
    const auto other =
        std::ranges::find_if(near, [](const auto& found) { return found.squared_distance > 0; });
    if (other != near.end()) shares.push_back(std::sqrt(other->squared_distance) / spacings[i]);
  }
  return shares.empty() ? 1 : median(shares);
}

bool is_irregular(const CellGrid& grid, std::span<const float> spacings) {
  return nearest_share(grid, spacings) < kIrregular;
}

}  // namespace palpate
