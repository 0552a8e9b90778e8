#include "viewer/cloud_of.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include "field/formulas.hpp"
#include "viewer/thinned.hpp"

namespace palpate::viewer {
namespace {

/// Of what has not faded away, in the grid's order.
std::vector<std::uint32_t> felt(const SurfacePoints& points) {
  const auto& weights = newest(points.density_weights, points.end_density_weights);
  const auto& presences = newest(points.presences, points.end_presences);
  std::vector<std::uint32_t> found;
  found.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const bool weighs = weights.empty() || weights[i] > 0;
    if (weighs && (presences.empty() || presences[i] > 0)) found.push_back(i);
  }
  return found;
}

}  // namespace

CloudMessage cloud_of(const SurfacePoints& points, const Eigen::Vector3d& origin,
                      std::size_t budget) {
  const std::vector<std::uint32_t> shown = felt(points);
  const std::vector<std::uint32_t> kept = thinned(shown.size(), budget);
  const auto& normals = newest(points.normals, points.end_normals);
  const auto& confidences = newest(points.confidences, points.end_confidences);
  const Eigen::Vector3f shift = (points.origin - origin).cast<float>();
  CloudMessage message;
  message.places.reserve(kept.size());
  message.trust.reserve(kept.size());
  if (!normals.empty()) message.normals.reserve(kept.size());
  if (!points.colors.empty()) message.colors.reserve(kept.size());
  for (const std::uint32_t k : kept) {
    const std::uint32_t i = shown[k];
    const Eigen::Vector3f& place =
        points.end_positions.empty() ? points.grid.points()[i] : points.end_positions[i];
    message.places.emplace_back(place + shift);
    if (!normals.empty()) message.normals.push_back(normals[i]);
    message.trust.push_back(static_cast<std::uint8_t>(std::lround(255 * confidences[i])));
    if (!points.colors.empty()) message.colors.push_back(points.colors[i]);
  }
  return message;
}

}  // namespace palpate::viewer
