#pragma once

#include <cmath>
#include <random>

#include "palpate/field/surface_points.hpp"

namespace palpate::test {

inline void add_edge(SurfacePoints& points, std::uint32_t i, const Eigen::Vector3f& normal,
                     const Eigen::Vector3f& place, float share) {
  points.edges.of_point.resize(points.size(), SurfacePoints::Edges::kNone);
  points.edges.of_point[i] = static_cast<std::uint32_t>(points.edges.start.size());
  points.edges.start.push_back({normal, normal.dot(points.grid.points()[i] - place), share});
}

/// Tells points with one of another face within R its plane: the nearest one's.
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
    const bool concave = (points.normals[i] - normal).dot(places[other] - places[i]) > 0;
    add_edge(points, i, normal, places[other], concave ? -1.0f : 1.0f);
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
    add_edge(points, i, normal, place, uniform(random));
  }
}

}  // namespace palpate::test
