#include "scene/disagreement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "field/newest.hpp"
#include "palpate/geometry/spacing.hpp"

namespace palpate {
namespace {

constexpr std::size_t kTried = 1000;
constexpr std::size_t kEnough = 30;
constexpr float kReach = 3;        // radii
constexpr float kAlike = 0.7071f;  // cosine between normals

const Eigen::Vector3f& end_of(const SurfacePoints& points, std::size_t i) {
  return points.end_positions.empty() ? points.grid.points()[i] : points.end_positions[i];
}

const Eigen::Vector3f& normal_of(const SurfacePoints& points, std::size_t i) {
  return newest(points.normals, points.end_normals)[i];
}

bool counts(const SurfacePoints& points, std::size_t i) {
  return newest(points.density_weights, points.end_density_weights)[i] > 0 &&
         points.confidences[i] > 0;
}

}  // namespace

std::optional<double> disagreement(const SurfacePoints& a, const SurfacePoints& b) {
  if (a.normals.empty() || b.normals.empty()) return std::nullopt;
  const Eigen::Vector3f shift = (a.origin - b.origin).cast<float>();
  const std::size_t step = std::max<std::size_t>(1, a.size() / kTried);
  std::vector<CellGrid::Neighbor> near;
  std::vector<float> distances;
  for (std::size_t i = 0; i < a.size(); i += step) {
    if (!counts(a, i)) continue;
    const Eigen::Vector3f place = end_of(a, i) + shift;
    b.grid.nearest(place, 1, near);
    if (near.empty()) continue;
    const std::size_t k = near.front().index;
    const Eigen::Vector3f& normal = normal_of(b, k);
    const Eigen::Vector3f way = place - end_of(b, k);
    const bool same =
        counts(b, k) && way.norm() <= kReach * b.radii[k] && normal.dot(normal_of(a, i)) > kAlike;
    if (same) distances.push_back(std::abs(normal.dot(way)));
  }
  if (distances.size() < kEnough) return std::nullopt;
  return median(distances);
}

}  // namespace palpate
