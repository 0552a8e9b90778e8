// Clouds that fade into each other are one surface that moves, not two.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "palpate/prepare/prepare.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A plane that prepare() puts on one sheet.
std::shared_ptr<const SurfacePoints> prepared_plane(double height) {
  PointCloud cloud;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      cloud.positions.push_back(Vector3d(3e-3 * i, 3e-3 * j, height).cast<float>());
    }
  }
  return test::share(prepare(cloud).points);
}

/// How far the proxy of a hand that presses 2 mm into the plane is from where the surface should be
/// while the plane fades into one `rise` above it, m; the most of all ticks.
double farthest_off(double rise) {
  Scene scene;
  Source& source = scene.add("clouds");
  SceneField field(scene);
  const auto old = prepared_plane(0);
  const auto next = prepared_plane(rise);
  EXPECT_FALSE(next->segments.empty());
  Proxy proxy;
  double farthest = 0;
  for (int k = 0; k < 400; ++k) {
    const double now = 1e-3 * k;
    test::publish_fade(source, k, old, next);
    const double height = rise * std::clamp(10 * now - 2, 0.0, 1.0);
    const Vector3d hip(0.3e-3, 0.4e-3, std::max(height - 2e-3, 10e-3 - 0.2e-3 * k));
    field.update(now, hip, proxy);
    (void)proxy.step(field, hip, 1e-3);
    if (k >= 100) farthest = std::max(farthest, std::abs(proxy.position().z() - height));
  }
  return farthest;
}

TEST(FadingClouds, AreOneSurfaceThatMoves) {
  const double radius = prepared_plane(0)->radius;
  for (const double share : {-0.6, -0.3, 0.3, 0.6}) {
    EXPECT_LT(farthest_off(share * radius), 0.2 * std::abs(share) * radius) << share << " R";
  }
}

}  // namespace
}  // namespace palpate
