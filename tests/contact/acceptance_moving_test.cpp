// docs/method.md 3.4: a cloud that steps under or over a resting hand takes the proxy along.
#include <gtest/gtest.h>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/point_shapes.hpp"
#include "support/rates.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

void show(Source& source, const std::vector<TestPoint>& points, double start,
          double duration = kFrame) {
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->start = start;
  snapshot->end = start + duration;
  if (!points.empty()) {
    snapshot->layers.push_back({std::make_shared<SurfacePoints>(make_points(points))});
  }
  source.publish(std::move(snapshot));
}

/// A hand that rests 3 mm deep in a sheet, which then steps by `dz`.
struct Stepped {
  Contact before;
  Contact after;  // in the tick of the step
  Contact settled;
};

Stepped step_surface(FieldOptions::Kind kind, double dz,
                     const Vector3d& hip = {0.001, 0.0005, -0.003}) {
  Scene scene;
  Source& source = scene.add("camera");
  const Sampling sampling{.jitter = 0.2};
  show(source, sheet(sampling, 0.04), 0);
  SceneField field(scene, {.kind = kind});
  Proxy proxy;
  proxy.reset({0.001, 0.0005, 0.04});
  double now = 0;
  const auto tick = [&](const Vector3d& to) {
    field.update(now, to, proxy);
    now += kTick;
    return proxy.step(field, to, kTick);
  };
  for (int i = 0; i <= 200; ++i) (void)tick(hip + (200 - i) * Vector3d(0, 0, 2e-4));
  Stepped result{.before = tick(hip), .after = {}, .settled = {}};
  show(source, sheet({.jitter = 0.2, .seed = 2}, 0.04, dz), now);
  result.after = tick(hip);
  for (int i = 0; i < 50; ++i) result.settled = tick(hip);
  return result;
}

using StepCase = std::tuple<FieldOptions::Kind, double>;
class AcceptanceStep : public testing::TestWithParam<StepCase> {};

TEST_P(AcceptanceStep, KeepsTheContactAndChangesTheForceByKdz) {
  const auto& [kind, dz] = GetParam();
  const Stepped stepped = step_surface(kind, dz);
  const double wanted = std::max(0.0, stepped.before.force.z() + 500 * dz);
  // The new sheet is another sample of the plane: a metaball's bumps are felt.
  const double tolerance = kind == FieldOptions::Kind::metaball ? 0.35 : 0.1;
  EXPECT_NEAR(stepped.after.force.z(), wanted, tolerance);
  EXPECT_NEAR(stepped.settled.force.z(), wanted, tolerance);
  EXPECT_EQ(stepped.after.touching, wanted > 0);
}

INSTANTIATE_TEST_SUITE_P(
    Steps, AcceptanceStep,
    testing::Combine(testing::Values(FieldOptions::Kind::balanced, FieldOptions::Kind::pointset,
                                     FieldOptions::Kind::metaball),
                     testing::Values(0.5e-3, 1e-3, 2e-3, 4e-3, 6e-3, 10e-3, 15e-3, -0.5e-3, -1e-3,
                                     -2e-3, -10e-3, -15e-3)));

TEST(AcceptanceStep, ACloudThatGoesAwayLetsGo) {
  Scene scene;
  Source& source = scene.add("camera");
  show(source, sheet({}, 0.04), 0);
  SceneField field(scene);
  Proxy proxy;
  proxy.reset({0, 0, 0.02});
  const Vector3d hip(0, 0, -0.003);
  field.update(0, hip, proxy);
  double before = proxy.step(field, hip, kTick).force.z();
  EXPECT_GT(before, 1);
  source.publish(nullptr);
  for (int i = 1; i <= 200; ++i) {
    field.update(i * kTick, hip, proxy);
    const Contact c = proxy.step(field, hip, kTick);
    EXPECT_FALSE(c.touching);
    EXPECT_LE(before - c.force.z(), 0.05 * 1.5);
    before = c.force.z();
  }
  EXPECT_EQ(before, 0);
}

// The gradient is zero there, and a re-anchoring of R / 2 begins inside the point's ball.
TEST(AcceptanceStep, ASinglePointThatAppearsAtTheProxyLiftsItToItsBall) {
  for (const double confidence : {0.0, 1.0}) {
    Scene scene;
    Source& source = scene.add("camera");
    show(source, sheet({}, 0.04), 0);
    SceneField field(scene);
    Proxy proxy;
    proxy.reset({0, 0, 0.02});
    const Vector3d hip(0, 0, -0.003);
    double now = 0;
    const auto tick = [&] {
      field.update(now, hip, proxy);
      now += kTick;
      return proxy.step(field, hip, kTick);
    };
    for (int i = 0; i < 10; ++i) (void)tick();
    show(source, {{proxy.position(), Vector3d::UnitZ(), 0.01, confidence}}, now, 0);
    const double size = confidence > 0 ? 0 : 0.0056;  // a trusted point is a piece of a plane
    for (int i = 0; i < 200; ++i) {
      const Contact c = tick();
      EXPECT_NEAR(c.proxy.z(), size, 1e-4);
      EXPECT_LE(c.force.z(), 1.55);  // what appears gives the hand nothing
      EXPECT_GE(c.force.z(), size > 0 ? 0.45 : 1.45);
    }
  }
}

}  // namespace
}  // namespace palpate::test
