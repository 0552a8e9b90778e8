// A whole scan with acute creases: whoever explores it from outside never gets inside.
#include <gtest/gtest.h>

#include <numbers>

#include "palpate/contact/proxy.hpp"
#include "palpate/device/exploration.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// How much of the solid angle around x the points show their backs to: 1 inside a closed surface,
/// 0 outside, 1/2 on it (Barill et al., Fast winding numbers for soups and clouds, 2018). A point
/// stands for the area that its weight leaves it in a plane.
double winding_number(const SurfacePoints& points, const Vector3d& x) {
  constexpr double kPlane = 2 * std::numbers::pi * 4 / 27;  // weight sum of one point per R^2
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d away = points.origin + points.grid.points()[i].cast<double>() - x;
    const double r = points.radii[i];
    const double area = kPlane * r * r * points.density_weights[i];
    const double distance = std::max(away.norm(), 0.2 * r);
    sum += area * points.normals[i].cast<double>().dot(away) / (distance * distance * distance);
  }
  return sum / (4 * std::numbers::pi);
}

/// The largest winding number at the proxy of a hand that explores the points.
double most_wound(Scene& scene, const SurfacePoints& points, const FieldOptions& options,
                  std::uint64_t seed) {
  const ExploredSurface surface{points.origin, points.grid.points(), points.normals};
  const Trajectory path = explore(
      surface,
      {.duration = 10, .radius = points.radius, .depth = 1.5 * points.radius, .seed = seed});
  SceneField field(scene, options);
  Proxy proxy;
  proxy.reset(path.front().position);
  double most = 0;
  int touching = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    field.update(path[i].time, path[i].position, proxy.position());
    if (proxy.step(field, path[i].position, kTick).touching) ++touching;
    if (i % 20 == 0) most = std::max(most, winding_number(points, proxy.position()));
  }
  EXPECT_GT(touching, static_cast<int>(path.size() / 2));
  return most;
}

TEST(ClosedObject, ARabbitIsNeverEntered) {
  for (const bool with_normals : {true, false}) {
    PointCloud cloud = synthetic_cloud("rabbit");
    if (!with_normals) cloud.normals.clear();
    Scene scene;
    const auto points = scene.add("rabbit", cloud).points();
    for (const FieldKind kind : {FieldKind::balanced, FieldKind::pointset}) {
      for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(effort(6)); ++seed) {
        EXPECT_LT(most_wound(scene, *points, {.kind = kind}, seed), 0.85) << "seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
