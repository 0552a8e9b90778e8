#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "palpate/scene/scene_field.hpp"
#include "support/make_points.hpp"

namespace palpate::test {

/// A square sheet at a height, R = 10 mm.
inline std::vector<TestPoint> plane(double height, double spacing = 4e-3, int half = 15) {
  std::vector<TestPoint> points;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      points.push_back({{spacing * i, spacing * j, height}, Eigen::Vector3d::UnitZ(), 10e-3, 1});
    }
  }
  return points;
}

inline std::shared_ptr<const SurfacePoints> share(SurfacePoints points) {
  return std::make_shared<const SurfacePoints>(std::move(points));
}

/// A snapshot that stands still from `start` on.
inline std::unique_ptr<Snapshot> still(const std::vector<TestPoint>& points, double start = 0) {
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->start = snapshot->end = start;
  snapshot->layers.push_back({share(make_points(points)), 1, 1});
  return snapshot;
}

/// The height of the surface above the origin as seen from +z.
inline double height_of(const SceneField& field) {
  double low = -40e-3;
  double high = 40e-3;
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    const Sample sample = field.sample({0.3e-3, 0.4e-3, z}, 1);
    const bool below = sample.support > 0.05 ? sample.height < 0 : z < 0;
    (below ? low : high) = z;
  }
  return 0.5 * (low + high);
}

}  // namespace palpate::test
