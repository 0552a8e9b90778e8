// Takes over the normals of a file where they agree with the points.

#include "prepare/given_normals.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

constexpr std::size_t kNormalSamples = 1000;  // points, about; enough for a median; judgement
constexpr std::size_t kNearbyNormals = 4;     // points, itself among them; judgement
constexpr float kAlikeCosine = 0.94f;         // 20 degrees; judgement
constexpr double kFewestGiven = 0.25;         // a smaller share counts as none; judgement

bool is_given(const Eigen::Vector3f& normal) {
  return normal.allFinite() && normal.squaredNorm() > 0;
}

/// How far normals turn from a point to its nearest, whatever their sign: the median of
/// 1 - |cosine|.
double variation(const CellGrid& grid, std::span<const Eigen::Vector3f> normals) {
  const std::size_t step = std::max<std::size_t>(1, grid.size() / kNormalSamples);
  std::vector<float> turns;
  std::vector<CellGrid::Neighbor> near;
  for (std::size_t i = 0; i < grid.size(); i += step) {
    if (!is_given(normals[i])) continue;
    grid.nearest(grid.points()[i], kNearbyNormals, near);
    for (const auto& [j, squared] : near) {
      if (squared > 0 && is_given(normals[j])) {
        turns.push_back(1 - std::abs(normals[i].normalized().dot(normals[j].normalized())));
      }
    }
  }
  return turns.empty() ? 1 : median(turns);
}

}  // namespace

double share_given(std::span<const Eigen::Vector3f> given) {
  if (given.empty()) return 0;
  return static_cast<double>(std::ranges::count_if(given, is_given)) /
         static_cast<double>(given.size());
}

void take_given_normals(const CellGrid& grid, std::span<const Eigen::Vector3f> given,
                        std::span<Eigen::Vector3f> normals) {
  if (share_given(given) < kFewestGiven) return;
  if (variation(grid, given) > variation(grid, normals)) return;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (!is_given(given[i])) continue;
    const Eigen::Vector3f unit = given[i].normalized();
    const float cosine = unit.dot(normals[i]);
    if (std::abs(cosine) >= kAlikeCosine) normals[i] = cosine < 0 ? Eigen::Vector3f(-unit) : unit;
  }
}

}  // namespace palpate
