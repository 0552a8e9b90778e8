#include "sim/simulated_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "palpate/base/error.hpp"
#include "sim/simulated_scene.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr CameraModel kSmallCamera{160, 120, {131, 130, 79.5, 59.5}, {}};

Vector3d ray_of(const CameraModel& camera, std::size_t pixel) {
  const int u = static_cast<int>(pixel) % camera.width;
  const int v = static_cast<int>(pixel) / camera.width;
  const Pinhole& p = camera.pinhole;
  return {(u - p.cx) / p.fx, (v - p.cy) / p.fy, 1};
}

double nearest(const std::vector<Solid>& solids, const Vector3d& x) {
  double value = INFINITY;
  for (const Solid& solid : solids) value = std::min(value, distance(solid, x));
  return value;
}

// The slow form: a step of the distance to the nearest solid cannot cross a surface.
double traced(const std::vector<Solid>& solids, const Eigen::Isometry3d& camera,
              const Vector3d& ray) {
  const Vector3d direction = camera.linear() * ray.normalized();
  double way = 0;
  for (int i = 0; i < 3000 && way < 20; ++i) {
    const double step = nearest(solids, camera.translation() + way * direction);
    if (step < 1e-9) break;
    way += step;
  }
  return way / ray.norm();
}

TEST(DepthRenderer, AgreesWithSphereTracing) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  for (int layout = 0; layout < kTableLayouts; ++layout) {
    const SimulatedTable table = make_simulated_table(layout);
    const std::vector<Solid> solids = solids_at(table.scene, 0);
    std::vector<float> depth;
    DepthRenderer(kSmallCamera).render(solids, table.T_world_camera, depth);
    ASSERT_EQ(depth.size(), 160u * 120u);
    int beyond = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      const double exact = traced(solids, table.T_world_camera, ray_of(kSmallCamera, i));
      if (std::abs(depth[i] - exact) > 1e-5) ++beyond;  // rays that graze
    }
    EXPECT_LE(beyond, 2);
  }
}

TEST(DepthRenderer, SeesNothingBehindItBeyondItsReachOrFromWithin) {
  const auto at = [](double z) {
    Solid ball{SolidKind::ball, Eigen::Isometry3d::Identity(), Vector3d::Constant(0.1)};
    ball.T_world_solid.translation().z() = z;
    return ball;
  };
  std::vector<float> depth;
  const DepthRenderer renderer(kSmallCamera, 2.0);
  for (const double z : {-0.5, 0.0, 0.05, 3.0}) {
    const std::vector<Solid> solids = {at(z)};
    renderer.render(solids, Eigen::Isometry3d::Identity(), depth);
    for (const float value : depth) EXPECT_EQ(value, 0) << z;
  }
  const std::vector<Solid> solids = {at(0.5)};
  renderer.render(solids, Eigen::Isometry3d::Identity(), depth);
  EXPECT_NEAR(depth[60 * 160 + 80], 0.4, 1e-4);
  EXPECT_EQ(depth[0], 0);
}

// Points seen through a distorting lens lie on the surface when its distortion is applied again.
TEST(DepthRenderer, BendsRaysAsTheLensDoes) {
  CameraModel camera = kSmallCamera;
  camera.distortion = {0.1, -0.05, 0.002, -0.001, 0.01};
  const CameraModel::Distortion& d = camera.distortion;
  Solid ball{SolidKind::ball, Eigen::Isometry3d::Identity(), Vector3d::Constant(0.3)};
  ball.T_world_solid.translation() = Vector3d(0.1, 0, 1);
  const std::vector<Solid> solids = {ball};
  std::vector<float> depth;
  DepthRenderer(camera).render(solids, Eigen::Isometry3d::Identity(), depth);
  int seen = 0;
  for (int i = 0; i < 400; ++i) {
    const double x = 0.1 + 0.2 * std::cos(0.7 * i) * (i / 400.0);
    const double y = 0.2 * std::sin(0.7 * i) * (i / 400.0);
    const double r2 = x * x + y * y;
    const double radial = 1 + d.k1 * r2 + d.k2 * r2 * r2 + d.k3 * r2 * r2 * r2;
    const double xd = x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x);
    const double yd = y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y;
    const int u = static_cast<int>(std::lround(camera.pinhole.fx * xd + camera.pinhole.cx));
    const int v = static_cast<int>(std::lround(camera.pinhole.fy * yd + camera.pinhole.cy));
    const float z = depth[static_cast<std::size_t>(v * camera.width + u)];
    // Half a pixel off, at these slopes.
    EXPECT_NEAR(distance(ball, z * Vector3d(x, y, 1)), 0, 4e-3);
    ++seen;
  }
  EXPECT_EQ(seen, 400);
}

TEST(DepthRenderer, RefusesACameraWithoutPixelsAndAWildLens) {
  EXPECT_THROW(DepthRenderer(CameraModel{}), Error);
  CameraModel camera = kSmallCamera;
  camera.distortion.k1 = -50;
  EXPECT_THROW(DepthRenderer{camera}, Error);
}

}  // namespace
}  // namespace palpate
