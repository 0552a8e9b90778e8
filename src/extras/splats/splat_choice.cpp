// Chooses splats by what they cost, which is their size in cells.
#include "extras/splats/splat_choice.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "palpate/geometry/spacing.hpp"

namespace palpate::detail {
namespace {

constexpr float kCoarser = 2;  // steps of edges, of which floats have 250 at most (derived)

// The size such that splats of half the opacity are smaller, m; 0 of none.
float typical_size(std::span<const Splat> splats) {
  std::vector<std::pair<float, float>> sizes;  // and opacities
  double all = 0;
  for (const Splat& splat : splats) {
    if (splat.opacity < kLeastOpacity) continue;
    const auto [a, b, c] = sorted_axes(splat);
    sizes.emplace_back(std::sqrt(splat.sigma[b]) * std::sqrt(splat.sigma[c]), splat.opacity);
    all += static_cast<double>(splat.opacity);
  }
  std::ranges::sort(sizes);
  double sum = 0;
  for (const auto& [size, opacity] : sizes) {
    sum += static_cast<double>(opacity);
    if (2 * sum >= all) return size;
  }
  return 0;
}

// Do splats of half the opacity take the usual number of samples or fewer?
bool most_are_usual(std::span<const Splat> splats, float edge) {
  double usual = 0;
  double all = 0;
  for (const Splat& splat : splats) {
    all += static_cast<double>(splat.opacity);
    if (samples_of(splat, edge) <= kUsualSamples) usual += static_cast<double>(splat.opacity);
  }
  return 2 * usual >= all;
}

// Leaves out the largest splats, such that the others together take no more samples than `budget`.
void leave_out_huge(double budget, SplatChoice& choice) {
  constexpr double kCountable = std::numeric_limits<std::int32_t>::max();  // of one splat
  const auto cost = [&](const Splat& splat) { return samples_of(splat, choice.grid.edge); };
  std::vector<double> costs(choice.splats.size());
  std::ranges::transform(choice.splats, costs.begin(), cost);
  std::ranges::sort(costs);
  double most = 0;
  double sum = 0;
  for (std::size_t i = 0, end = 0; i < costs.size(); i = end) {  // all of a cost, or none
    double more = 0;
    while (end < costs.size() && costs[end] == costs[i]) more += costs[end++];
    if (sum + more > budget || costs[i] > kCountable) break;
    most = costs[i];
    sum += more;
  }
  choice.samples = static_cast<std::size_t>(sum);
  choice.huge =
      std::erase_if(choice.splats, [&](const Splat& splat) { return cost(splat) > most; });
}

Eigen::Vector3f middle_of(std::span<const Splat> splats) {
  Eigen::Vector3f middle;
  std::vector<float> values(splats.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(splats, values.begin(),
                           [&](const Splat& splat) { return splat.position[axis]; });
    middle[axis] = static_cast<float>(median(values));
  }
  return middle;
}

}  // namespace

SplatChoice choose_splats(std::span<const Splat> splats) {
  SplatChoice choice;
  std::ranges::copy_if(splats, std::back_inserter(choice.splats),
                       [](const Splat& splat) { return splat.opacity >= kFaintest; });
  SplatGrid& grid = choice.grid;
  grid.edge = typical_size(choice.splats);
  if (!(grid.edge > 0)) return choice;
  while (!most_are_usual(choice.splats, grid.edge)) grid.edge *= kCoarser;
  grid.middle = middle_of(choice.splats);
  choice.far = std::erase_if(choice.splats,
                             [&](const Splat& splat) { return !grid.key_of(splat.position); });
  leave_out_huge(static_cast<double>(kUsualSamples * splats.size()), choice);
  return choice;
}

}  // namespace palpate::detail
