// Checks what a field answers about scenes whose surface is known.
#include "palpate/scene/scene_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/snapshots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::height_of;
using test::make_points;
using test::plane;
using test::share;
using test::still;
using test::TestPoint;

TEST(SceneField, WithoutASurfaceEverythingIsFree) {
  Scene scene;
  scene.add("empty");
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::no_surface));
  EXPECT_TRUE(field.is_free({Vector3d::Zero(), 1}));
  EXPECT_EQ(field.sample(Vector3d::Zero()).support, 0);
  EXPECT_GT(field.sample(Vector3d::Zero()).value, 0);
  EXPECT_EQ(field.surface(Vector3d::Zero()).source, -1);
}

TEST(SceneField, SamplesAwayFromThePathAreAsGoodAsThoseOnIt) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  const Vector3d here(1e-3, 2e-3, 3e-3);
  field.update_from(0, here, here);
  for (double x = -40e-3; x <= 40e-3; x += 3e-3) {
    const Sample sample = field.sample({x, 1e-3, 2e-3});
    EXPECT_NEAR(sample.value, 2e-3, 1e-9);
    EXPECT_FALSE(field.is_free({{x, 1e-3, 2e-3}, 1e-3}));
    EXPECT_TRUE(field.is_free({{x, 1e-3, 25e-3}, 10e-3}));
    EXPECT_FALSE(field.is_free({{x, 1e-3, 25e-3}, 20e-3}));
  }
}

TEST(SceneField, KeepsItsPatchWhileTheToolStaysNear) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  SceneField field(scene);
  Vector3d x(0, 0, 2e-3);
  for (int k = 0; k < 100; ++k) {
    x.x() += 0.1e-3;
    field.update_from(1e-3 * k, x, x);
    EXPECT_NEAR(field.sample(x).value, 2e-3, 1e-9);
  }
  EXPECT_LE(field.gathers(), 5u);
}

TEST(SceneField, ChangesOverAtTheNextSnapshotsStart) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  const auto revision = field.traits().revision;
  source.publish(still(plane(4e-3), 0.010));
  field.update_from(0.009, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(height_of(field), 0, 1e-6);
  EXPECT_EQ(field.traits().revision, revision);
  field.update_from(0.010, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(height_of(field), 4e-3, 1e-6);
  EXPECT_GT(field.traits().revision, revision);
}

TEST(SceneField, ChangesToWhatAFieldOfThoseOptionsIs) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  const FieldOptions metaball{.kind = FieldOptions::Kind::metaball, .threshold = 0.5};
  SceneField changed(scene);
  SceneField made(scene, metaball);
  const Vector3d x(1e-3, 2e-3, 6e-3);
  changed.update_from(0, x, x);
  const auto revision = changed.traits().revision;
  changed.change(metaball);
  changed.update_from(1e-3, x, x);
  made.update_from(1e-3, x, x);
  EXPECT_GT(changed.traits().revision, revision);
  EXPECT_EQ(changed.sample(x).value, made.sample(x).value);
  EXPECT_EQ(changed.sample(x).gradient, made.sample(x).gradient);
  changed.change(paper_field());  // one R for all, and back
  changed.update_from(2e-3, x, x);
  changed.change(metaball);
  changed.update_from(3e-3, x, x);
  EXPECT_EQ(changed.sample(x).value, made.sample(x).value);
}

TEST(SceneField, ASurfaceThatIsTakenAwayIsGone) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  source.publish(nullptr);
  field.update_from(0.001, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(field.is_free({Vector3d::Zero(), 0.1}));
}

TEST(SceneField, MovingPointsCarryTheSurfaceInAStraightLine) {
  Scene scene;
  Source& source = scene.add("plane");
  SurfacePoints points = make_points(plane(0));
  for (const auto& p : points.grid.points()) {
    points.end_positions.push_back(p + Eigen::Vector3f(0, 0, 6e-3f));
  }
  finish(points);
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->start = 1;
  snapshot->end = 1.03;
  snapshot->layers.push_back({share(std::move(points)), 1, 1});
  source.publish(std::move(snapshot));
  SceneField field(scene);
  for (const double u : {-0.1, 0.0, 0.25, 0.5, 1.0, 2.0}) {
    field.update_from(1 + 0.03 * u, Vector3d::Zero(), Vector3d::Zero());
    const double expected = 6e-3 * std::clamp(u, 0.0, 1.0);
    EXPECT_NEAR(height_of(field), expected, 1e-6) << "u = " << u;
    const double speed = u > 0 && u < 1 ? 0.2 : 0;
    EXPECT_NEAR(field.surface({0, 0, expected}).velocity.z(), speed, 1e-6);
  }
}

TEST(SceneField, LayersFadeIntoOneAnother) {
  Scene scene;
  Source& source = scene.add("plane");
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->end = 1;
  snapshot->layers.push_back({share(make_points(plane(0))), 1, 0});
  snapshot->layers.push_back({share(make_points(plane(1e-3))), 0, 1});
  source.publish(std::move(snapshot));
  SceneField field(scene);
  double before = -1e-9;
  for (double t = 0; t <= 1.0001; t += 0.1) {
    field.update_from(t, Vector3d::Zero(), Vector3d::Zero());
    const double height = height_of(field);
    EXPECT_GT(height, before);
    EXPECT_NEAR(height, 1e-3 * t, 0.05e-3);
    before = height - 1e-9;
  }
}

TEST(SceneField, TwoSourcesMakeOneSurface) {
  Scene scene;
  auto left = plane(0);
  auto right = plane(0);
  std::erase_if(left, [](const TestPoint& p) { return p.position.x() > 4e-3; });
  std::erase_if(right, [](const TestPoint& p) { return p.position.x() < -4e-3; });
  scene.add("left").publish(still(left));
  scene.add("right").publish(still(right));
  SceneField field(scene);
  for (double x = -30e-3; x <= 30e-3; x += 2e-3) {
    const Vector3d place(x, 0, 1e-3);
    field.update_from(0, place, place);
    EXPECT_NEAR(field.sample(place).value, 1e-3, 1e-6) << x;
    EXPECT_EQ(field.surface(place).source, x < 0 ? 0 : 1);
  }
}

TEST(SceneField, MaterialsGoFromSoftToFull) {
  Scene scene;
  Source& source =
      scene.add("plane", SourceOptions{.soft = {.stiffness_factor = 0.2, .friction_factor = 0.5}});
  SurfacePoints points = make_points(plane(0));
  for (const auto& p : points.grid.points()) points.materials.push_back(p.x() < 0 ? 0.0f : 1.0f);
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back({share(std::move(points)), 1, 1});
  source.publish(std::move(snapshot));
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(field.surface({-30e-3, 0, 0}).stiffness_factor, 0.2, 1e-9);
  EXPECT_NEAR(field.surface({-30e-3, 0, 0}).friction_factor, 0.5, 1e-9);
  EXPECT_NEAR(field.surface({30e-3, 0, 0}).stiffness_factor, 1, 1e-9);
  const double between = field.surface({0, 0, 0}).stiffness_factor;
  EXPECT_GT(between, 0.3);
  EXPECT_LT(between, 1);
}

}  // namespace
}  // namespace palpate
