#pragma once

#include <cmath>
#include <random>

#include "palpate/field/surface_points.hpp"

namespace palpate::test {

/// Tells points with a face of another direction within R the plane of its nearest point, as what
/// makes frames into points does.
inline void tell_edges(SurfacePoints& points) {
  const auto& places = points.grid.points();
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint32_t other = i;
    float nearest = points.radii[i] * points.radii[i];
    for (std::uint32_t j = 0; j < points.size(); ++j) {
      const float squared = (places[j] - places[i]).squaredNorm();
      const bool turned = std::abs(points.normals[j].dot(points.normals[i])) < 0.866f;
      if (!turned || squared >= nearest) continue;
      nearest = squared;
      other = j;
    }
    if (other == i) continue;
    const Eigen::Vector3f& normal = points.normals[other];
    const bool concave = points.normals[i].dot(places[other] - places[i]) > 0;
    points.edges.points.push_back(i);
    points.edges.start.push_back({normal, normal.dot(places[other]), concave ? -1.0f : 1.0f});
  }
}

/// Tells two of three points about any plane that passes nearby, convex or in a crease.
inline void draw_edges(SurfacePoints& points, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (i % 3 == 0) continue;
    const Eigen::Vector3f turn(uniform(random), uniform(random), uniform(random));
    const Eigen::Vector3f normal = (points.normals[i] + turn).normalized();
    const Eigen::Vector3f place = points.grid.points()[i] + points.radii[i] * 0.3f * turn;
    points.edges.points.push_back(i);
    points.edges.start.push_back({normal, normal.dot(place), uniform(random)});
  }
}

}  // namespace palpate::test
