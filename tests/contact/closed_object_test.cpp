// A whole scan with acute creases: whoever explores it from outside never gets inside.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "device/explore.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/io/synthetic.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// A part of the synthetic rabbit, as src/io/synthetic.cpp has it.
struct Ellipsoid {
  Vector3d center;
  Vector3d axes;
  double forward = 0;  // how it leans, rad
  double aside = 0;

  /// How deep x is inside, to first order, m; below 0 outside.
  [[nodiscard]] double depth(const Vector3d& x) const {
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(aside, Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(forward, Vector3d::UnitY()))
                                     .toRotationMatrix();
    const Vector3d local = turn.transpose() * (x - center);
    const double k = local.cwiseQuotient(axes).norm();
    const Vector3d slope = local.cwiseQuotient(axes.cwiseProduct(axes)) / k;
    return (1 - k) / slope.norm();
  }
};

constexpr double kRightEar = -0.2;
const std::array<Ellipsoid, 9> kRabbit = {{
    {{-0.020, 0, 0.055}, {0.070, 0.050, 0.055}, -0.35},
    {{0.035, 0, 0.060}, {0.038, 0.036, 0.050}, 0.25},
    {{0.055, 0, 0.115}, {0.036, 0.028, 0.029}, 0.30},
    {{0.030, 0.016, 0.165}, {0.013, 0.008, 0.045}, -0.35, kRightEar},
    {{0.030, -0.016, 0.165}, {0.013, 0.008, 0.045}, -0.35, -kRightEar},
    {{-0.010, 0.040, 0.030}, {0.045, 0.020, 0.030}},
    {{-0.010, -0.040, 0.030}, {0.045, 0.020, 0.030}},
    {{0.058, 0.018, 0.014}, {0.026, 0.012, 0.014}},
    {{-0.090, 0, 0.040}, {0.018, 0.018, 0.018}},
}};

/// How deep x is inside the rabbit, m. It sits on z = 0 and has no points there.
double depth_inside(const Vector3d& x) {
  double most = -1;
  for (const Ellipsoid& part : kRabbit) most = std::max(most, part.depth(x));
  return std::min(most, x.z());
}

/// How deep the proxy of a hand that explores the points gets inside, in R.
double deepest(Scene& scene, const SurfacePoints& points, const FieldOptions& options,
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
    field.update(path[i].time, path[i].position, proxy);
    if (proxy.step(field, path[i].position, kTick).touching) ++touching;
    most = std::max(most, depth_inside(proxy.position()) / points.radius);
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
    for (const FieldOptions::Kind kind :
         {FieldOptions::Kind::balanced, FieldOptions::Kind::pointset}) {
      for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(effort(6)); ++seed) {
        EXPECT_LT(deepest(scene, *points, {.kind = kind}, seed), 0.35) << "seed " << seed;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
