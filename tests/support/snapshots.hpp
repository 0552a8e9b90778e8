#pragma once

#include <limits>
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

/// Publishes, at ticks 0, 100, 200 and 300 of 1 ms, `old` twice, its change into `next` in 0.1 s,
/// and `next`.
inline void publish_fade(Source& source, int tick, const std::shared_ptr<const SurfacePoints>& old,
                         const std::shared_ptr<const SurfacePoints>& next) {
  if (tick % 100 != 0) return;
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->interval = 0.1;
  snapshot->start = 1e-3 * tick;
  snapshot->end = snapshot->start + snapshot->interval;
  if (tick < 200) snapshot->layers = {{old, 1, 1}};
  if (tick == 200) snapshot->layers = {{old, 1, 0}, {next, 0, 1}};
  if (tick == 300) snapshot->layers = {{next, 1, 1}};
  source.publish(std::move(snapshot));
}

/// The height of the surface above the origin, from whichever side it is seen: of the places where
/// solid ends, the one with most points around it. NaN: there is none.
inline double height_of(const SceneField& field) {
  constexpr double kStep = 0.5e-3;
  const auto at = [&](double z) { return field.sample({0.3e-3, 0.4e-3, z}); };
  double height = std::numeric_limits<double>::quiet_NaN();
  double support = 0;
  bool solid = false;
  for (double z = -40e-3; z < 40e-3; z += kStep) {
    if (std::exchange(solid, at(z + kStep).value < 0) == solid) continue;
    double low = z;
    double high = z + kStep;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      ((at(middle).value < 0) == solid ? high : low) = middle;
    }
    if (at(low).support <= support) continue;
    support = at(low).support;
    height = low;
  }
  return height;
}

}  // namespace palpate::test
