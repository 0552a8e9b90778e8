// How far a surface may have stepped when a snapshot takes another's place.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "palpate/contact/proxy.hpp"
#include "scene/source_view.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kLasts = 0.1;  // s

Snapshot snapshot_of(std::vector<Snapshot::Layer> layers) {
  Snapshot snapshot;
  snapshot.end = kLasts;
  snapshot.interval = kLasts;
  snapshot.layers = std::move(layers);
  return snapshot;
}

TEST(TimeStepped, IsThatOfACloudThatIsThereAtOnce) {
  const auto before = test::share(test::make_points(test::plane(0)));
  const auto after = test::share(test::make_points(test::plane(0.01)));
  const std::vector<ActiveLayer> shown{{before.get()}};
  EXPECT_EQ(time_stepped(snapshot_of({{after, 1, 1}}), shown), kLasts);
  EXPECT_EQ(time_stepped(snapshot_of({{before, 0.5, 0.5}, {after, 0.5, 0.5}}), shown), kLasts);
  EXPECT_EQ(time_stepped(snapshot_of({{after, 1, 1}}), {}), kLasts);
}

TEST(TimeStepped, IsNothingWhereWhatWasThereGoesOnOrFades) {
  const auto before = test::share(test::make_points(test::plane(0)));
  const auto after = test::share(test::make_points(test::plane(0.01)));
  const std::vector<ActiveLayer> shown{{before.get()}};
  EXPECT_EQ(time_stepped(snapshot_of({{before, 1, 1}}), shown), 0);
  EXPECT_EQ(time_stepped(snapshot_of({{before, 1, 0}, {after, 0, 1}}), shown), 0);
  EXPECT_EQ(time_stepped(snapshot_of({}), shown), 0);
}

/// The largest change of force in a tick, of a hand that presses 3 mm into a plane that fades into
/// one 12 mm above it.
double largest_step_while_fading() {
  Scene scene;
  Source& source = scene.add("clouds");
  SceneField field(scene);
  const auto low = test::share(test::make_points(test::plane(0)));
  const auto high = test::share(test::make_points(test::plane(12e-3)));
  Proxy proxy;
  Vector3d last = Vector3d::Zero();
  double largest = 0;
  for (int k = 0; k < 400; ++k) {
    const double now = 1e-3 * k;
    test::publish_fade(source, k, low, high);
    const Vector3d hip(0, 0, std::max(-3e-3, 10e-3 - 0.2e-3 * k));
    field.update(now, hip, proxy);
    const Vector3d force = proxy.step(field, hip, 1e-3).force;
    if (k > 0) largest = std::max(largest, (force - last).norm());
    last = force;
  }
  EXPECT_GT(proxy.position().z(), 8e-3);  // the upper plane holds it in the end
  return largest;
}

TEST(TimeStepped, SurfaceThatFadesInAboveAHandDoesNotPushIt) {
  EXPECT_LE(largest_step_while_fading(), 0.6);  // K (1 m/s dt + the hand's 2 x 0.2 mm), in N
}

/// A sheet of points 0.8 mm apart at a height, R = 10 mm: some 900 points around a tool.
std::unique_ptr<Snapshot> dense_sheet(double height, double start) {
  constexpr int kHalf = 56;
  constexpr double kSpacing = 0.8e-3;
  std::vector<Eigen::Vector3f> places;
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (int j = -kHalf; j <= kHalf; ++j) {
      places.push_back(Vector3d(kSpacing * i, kSpacing * j, height).cast<float>());
    }
  }
  SurfacePoints points;
  points.grid = CellGrid(places);
  points.normals.assign(points.size(), Eigen::Vector3f::UnitZ());
  points.density_weights.assign(points.size(), 6e-3f);  // 3 in all of a support
  points.radii.assign(points.size(), 10e-3f);
  points.confidences.assign(points.size(), 1);
  finish(points);
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->start = snapshot->end = start;
  snapshot->interval = 0.033;
  snapshot->layers.push_back({test::share(std::move(points)), 1, 1});
  return snapshot;
}

// The look from above costs more than a step has. Its underside, which Newton finds, is no surface
// for the proxy.
TEST(TimeStepped, DenseSheetThatStepsUpTakesTheProxyAlong) {
  for (const double rise : {4e-3, 5e-3}) {
    Scene scene;
    Source& source = scene.add("sheet");
    source.publish(dense_sheet(0, 0));
    SceneField field(scene);
    Proxy proxy;
    Vector3d hip(0.3e-3, 0.4e-3, 0.02);
    proxy.reset(hip);
    for (int k = 0; k < 500; ++k) {
      if (k < 220) hip.z() -= 1e-4;  // 2 mm below the sheet in the end
      if (k == 220) source.publish(dense_sheet(rise, 0.22));
      field.update(1e-3 * k, hip, proxy);
      (void)proxy.step(field, hip, 1e-3);
    }
    EXPECT_NEAR(proxy.position().z(), rise, 1e-4);
  }
}

}  // namespace
}  // namespace palpate
