#include "field/active_layer.hpp"

#include <algorithm>

namespace palpate {
namespace {

double lerp(double a, double b, double u) noexcept {
  return a + u * (b - a);
}

double own_radius(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.radii[i];
  return points.end_radii.empty() ? start : lerp(start, points.end_radii[i], layer.progress);
}

/// C_k, less where the point was widened.
double layer_weight(const ActiveLayer& layer, std::uint32_t i) noexcept {
  if (!(layer.least_radius > 0)) return layer.weight;
  const double share = std::min(1.0, own_radius(layer, i) / layer.least_radius);
  return share * share * layer.weight;
}

}  // namespace

Eigen::Vector3d normal_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  if (points.normals.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d start = points.normals[i].cast<double>();
  if (points.end_normals.empty()) return start;
  const Eigen::Vector3d mixed =
      start + layer.progress * (points.end_normals[i].cast<double>() - start);
  const double length = mixed.norm();
  return length > 1e-6 ? Eigen::Vector3d(mixed / length) : start;
}

Eigen::Vector3d velocity_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  if (points.end_positions.empty()) return Eigen::Vector3d::Zero();
  return layer.rate * (points.end_positions[i] - points.grid.points()[i]).cast<double>();
}

double weight_now(const ActiveLayer& layer, std::uint32_t i, bool raw_weights) noexcept {
  const double weight = layer_weight(layer, i);
  if (raw_weights) return weight;
  const SurfacePoints& points = *layer.points;
  const double start = points.density_weights[i];
  if (points.end_density_weights.empty()) return weight * start;
  return weight * lerp(start, points.end_density_weights[i], layer.progress);
}

double radius_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  return std::max(own_radius(layer, i), layer.least_radius);
}

double confidence_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.confidences[i];
  return points.end_confidences.empty() ? start
                                        : lerp(start, points.end_confidences[i], layer.progress);
}

SurfacePoints::EdgePlane edge_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  if (!has_edge(layer, i)) return {};
  const SurfacePoints::Edges& edges = layer.points->edges;
  const SurfacePoints::EdgePlane& start = edges.start[edges.of_point[i]];
  if (edges.end.empty()) return start;
  const SurfacePoints::EdgePlane& end = edges.end[edges.of_point[i]];
  const auto u = static_cast<float>(layer.progress);
  return {start.normal + u * (end.normal - start.normal),
          start.height + u * (end.height - start.height),
          start.share + u * (end.share - start.share)};
}

double presence_now(const ActiveLayer& layer, std::uint32_t i) noexcept {
  const SurfacePoints& points = *layer.points;
  const double start = points.presences.empty() ? 1.0 : points.presences[i];
  if (points.end_presences.empty()) return start;
  return lerp(start, points.end_presences[i], layer.progress);
}

}  // namespace palpate
