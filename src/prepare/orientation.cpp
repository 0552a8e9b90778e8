// Turns normals until those of neighbours agree and point to the free side.

#include "prepare/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/signed_sets.hpp"

namespace palpate {
namespace {

constexpr std::size_t kLookedAt = 9;  // points; derived: one of a grid and the eight around it

/// Two neighbours, and the cosine between their normals as they are.
struct Pair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  float cosine = 0;
};

std::vector<Pair> pairs_of(const CellGrid& grid, const PointFits& fits) {
  std::vector<Pair> pairs;
  std::vector<CellGrid::Neighbor> near;
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    if (fits.normals[i].isZero()) continue;
    grid.nearest(grid.points()[i], kLookedAt, near);
    for (const CellGrid::Neighbor& other : near) {
      const std::uint32_t j = other.index;
      if (j == i || fits.normals[j].isZero()) continue;
      pairs.push_back({i, j, fits.normals[i].dot(fits.normals[j])});
    }
  }
  std::ranges::stable_sort(
      pairs, [](const Pair& x, const Pair& y) { return std::abs(x.cosine) > std::abs(y.cosine); });
  return pairs;
}

/// Votes for the free side of a set of points, relative to the sign of its root.
struct Votes {
  double given = 0;
  double seen = 0;
  double outward = 0;
};

Eigen::Vector3d middle_of(const CellGrid& grid) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : grid.points()) sum += p.cast<double>();
  return sum / static_cast<double>(std::max<std::size_t>(1, grid.size()));
}

/// The votes of one point, whose normal is `normal`.
void add(const PriorSigns& prior, const Eigen::Vector3d& middle, std::uint32_t i,
         const Eigen::Vector3f& p, const Eigen::Vector3f& normal, Votes& votes) {
  if (!prior.given.empty() && prior.given[i].allFinite()) {
    votes.given += static_cast<double>(prior.given[i].dot(normal));
  }
  if (prior.eye) votes.seen += static_cast<double>((*prior.eye - p).normalized().dot(normal));
  votes.outward += (p.cast<double>() - middle).dot(normal.cast<double>());
}

bool is_inward(const Votes& votes) {
  if (votes.given != 0) return votes.given < 0;
  if (votes.seen != 0) return votes.seen < 0;
  return votes.outward < 0;
}

}  // namespace

PriorSigns given_signs(const Placed& placed, const Sampling& sampling,
                       const PrepareOptions& options) {
  using Orientation = PrepareOptions::Orientation;
  const Orientation how = options.orientation;
  PriorSigns prior;
  const bool seen = how == Orientation::automatic || how == Orientation::viewpoint;
  if (seen && placed.viewpoint) prior.eye = (*placed.viewpoint - sampling.origin).cast<float>();
  const bool given = how == Orientation::automatic || how == Orientation::given;
  const bool requested = options.viewpoint && how != Orientation::given;
  if (given && !requested) prior.given = sampling.normals;
  if (options.facts) prior.middle = options.facts->extent.center() - sampling.origin;
  return prior;
}

void orient(const Sampling& sampling, const PriorSigns& prior, PointFits& fits) {
  if (fits.normals.empty()) return;
  const CellGrid& grid = sampling.grid;
  detail::SignedSets sets(grid.size());
  for (const Pair& pair : pairs_of(grid, fits)) {
    sets.join(pair.a, pair.b, pair.cosine < 0 ? -1 : 1);
  }
  const Eigen::Vector3d middle = prior.middle.value_or(middle_of(grid));
  std::vector<Votes> votes(grid.size());  // at the roots
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    const auto [root, sign] = sets.find(i);
    if (sign < 0) fits.normals[i] = -fits.normals[i];
    add(prior, middle, i, grid.points()[i], fits.normals[i], votes[root]);
  }
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    if (is_inward(votes[sets.find(i).first])) fits.normals[i] = -fits.normals[i];
  }
}

}  // namespace palpate
