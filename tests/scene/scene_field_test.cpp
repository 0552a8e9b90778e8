#include "palpate/scene/scene_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "palpate/base/error.hpp"
#include "support/make_points.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::make_points;
using test::TestPoint;

constexpr double kRadius = 10e-3;

std::vector<TestPoint> plane(double height, double spacing = 4e-3, int half = 15) {
  std::vector<TestPoint> points;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      points.push_back({{spacing * i, spacing * j, height}, Vector3d::UnitZ(), kRadius, 1});
    }
  }
  return points;
}

std::shared_ptr<const SurfacePoints> share(SurfacePoints points) {
  return std::make_shared<const SurfacePoints>(std::move(points));
}

std::unique_ptr<Snapshot> still(const std::vector<TestPoint>& points, double start = 0) {
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->start = snapshot->end = start;
  snapshot->layers.push_back({share(make_points(points)), 1, 1});
  return snapshot;
}

/// The height of the surface above the origin as seen from +z.
double height_of(const SceneField& field) {
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

TEST(SceneField, WithoutASurfaceEverythingIsFree) {
  Scene scene;
  scene.add("empty");
  SceneField field(scene);
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::no_surface));
  EXPECT_TRUE(field.is_free({Vector3d::Zero(), 1}));
  EXPECT_EQ(field.sample(Vector3d::Zero(), 1).support, 0);
  EXPECT_GT(field.sample(Vector3d::Zero(), 1).value, 0);
  EXPECT_EQ(field.surface(Vector3d::Zero()).source, -1);
}

TEST(SceneField, SamplesAwayFromThePathAreAsGoodAsThoseOnIt) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  const Vector3d here(1e-3, 2e-3, 3e-3);
  field.update(0, here, here);
  for (double x = -40e-3; x <= 40e-3; x += 3e-3) {
    const Sample sample = field.sample({x, 1e-3, 2e-3}, 1);
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
    field.update(1e-3 * k, x, x);
    EXPECT_NEAR(field.sample(x, 1).value, 2e-3, 1e-9);
  }
  EXPECT_LE(field.gathers(), 5u);
}

TEST(SceneField, ChangesOverAtTheNextSnapshotsStart) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  const auto revision = field.traits().revision;
  source.publish(still(plane(4e-3), 0.010));
  field.update(0.009, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(height_of(field), 0, 1e-6);
  EXPECT_EQ(field.traits().revision, revision);
  field.update(0.010, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(height_of(field), 4e-3, 1e-6);
  EXPECT_GT(field.traits().revision, revision);
}

TEST(SceneField, ASurfaceThatIsTakenAwayIsGone) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  source.publish(nullptr);
  field.update(0.001, Vector3d::Zero(), Vector3d::Zero());
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
    field.update(1 + 0.03 * u, Vector3d::Zero(), Vector3d::Zero());
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
    field.update(t, Vector3d::Zero(), Vector3d::Zero());
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
    field.update(0, place, place);
    EXPECT_NEAR(field.sample(place, 1).value, 1e-3, 1e-6) << x;
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
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(field.surface({-30e-3, 0, 0}).stiffness_factor, 0.2, 1e-9);
  EXPECT_NEAR(field.surface({-30e-3, 0, 0}).friction_factor, 0.5, 1e-9);
  EXPECT_NEAR(field.surface({30e-3, 0, 0}).stiffness_factor, 1, 1e-9);
  const double between = field.surface({0, 0, 0}).stiffness_factor;
  EXPECT_GT(between, 0.3);
  EXPECT_LT(between, 1);
}

TEST(SceneField, NonFiniteArgumentsAreHarmless) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  SceneField field(scene);
  const Vector3d nan = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Vector3d huge = Vector3d::Constant(1e300);
  field.update(0, nan, Vector3d::Zero());
  field.update(0, huge, huge);
  EXPECT_TRUE(field.sample(huge, 1).gradient.allFinite());
  EXPECT_EQ(field.sample(nan, 1).support, 0);
  EXPECT_FALSE(field.is_free({nan, 1}));
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(field.sample({0, 0, 1e-3}, 1).value, 1e-3, 1e-9);
}

TEST(SceneField, AnOverfullPatchIsThinnedAndSaysSo) {
  Scene scene;
  auto dense = plane(0, 0.5e-3, 30);
  for (TestPoint& p : dense) p.radius = 30e-3;
  scene.add("plane").publish(still(dense));
  SceneField field(scene);
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::thinned));
  EXPECT_LE(field.patch_points(), SceneField::kPatchPoints);
  EXPECT_NEAR(field.sample({0, 0, 1e-3}, 1).value, 1e-3, 1e-9);
}

TEST(SceneField, ALayerWithoutPointsChangesNothing) {
  Scene scene;
  Source& source = scene.add("camera");
  auto snapshot = still(plane(0));
  snapshot->layers.push_back({share(make_points({})), 1, 1});
  source.publish(std::move(snapshot));
  for (const double tool : {0.0, 1e-3}) {
    SceneField field(scene, {.tool_radius = tool});
    const Vector3d high(0, 0, 0.5);
    field.update(0, high, high);
    EXPECT_GT(field.sample(high, 1).value, 0);
    EXPECT_TRUE(field.is_free({high, 0.4}));
    EXPECT_GT(field.traits().resolution, 0);
    EXPECT_NEAR(field.sample({0, 0, 2e-3}, 1).value, 2e-3 - tool, 1e-9);
  }
  source.publish([] {
    auto nothing = std::make_unique<Snapshot>();
    nothing->layers.push_back({share(make_points({})), 1, 1});
    return nothing;
  }());
  SceneField field(scene, {.tool_radius = 1e-3});
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::no_surface));
  EXPECT_TRUE(field.is_free({Vector3d::Zero(), 1}));
}

TEST(SceneField, ATimeThatIsNotFiniteLeavesTheSurfaceWhereItWas) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  SceneField field(scene);
  const Vector3d x(0, 0, 1e-3);
  field.update(0.5, x, x);
  field.update(std::numeric_limits<double>::quiet_NaN(), x, x);
  EXPECT_TRUE(has(field.notes(), FieldNote::time_not_finite));
  EXPECT_NEAR(field.sample(x, 1).value, 1e-3, 1e-9);
  field.update(0.501, x, x);
  EXPECT_FALSE(has(field.notes(), FieldNote::time_not_finite));
}

TEST(SceneField, ASnapshotOfAWrongClockDoesNotBlockLaterOnes) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
  source.publish(still(plane(4e-3), 1e9));
  field.update(0.01, Vector3d::Zero(), Vector3d::Zero());
  source.publish(still(plane(2e-3), 0.02));
  field.update(0.02, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(height_of(field), 2e-3, 1e-6);
}

TEST(SceneField, PresenceGoesFromItsStartToItsEnd) {
  Scene scene;
  auto snapshot = still(plane(0));
  snapshot->end = 1;
  snapshot->presence_start = 1;
  snapshot->presence_end = 0.5;
  scene.add("plane").publish(std::move(snapshot));
  SceneField field(scene);
  for (const double t : {0.0, 0.5, 1.0, 2.0}) {
    field.update(t, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_NEAR(field.surface(Vector3d::Zero()).presence, 1 - 0.5 * std::min(t, 1.0), 1e-12);
  }
}

TEST(SceneField, OneRadiusForAllIsOneEverywhere) {
  // Left half with small, right half with large radii: the paper takes that of the nearest point.
  auto points = plane(0);
  for (TestPoint& p : points) p.radius = p.position.x() < 0 ? 8e-3 : 16e-3;
  Scene scene;
  scene.add("plane").publish(still(points));
  FieldOptions options = paper_field(FieldKind::metaball);
  SceneField field(scene, options);
  const Vector3d left(-20e-3, 0, 5e-3);
  field.update(0, left, left);
  EXPECT_NEAR(field.sample(left, 1).radius, 8e-3, 1e-9);
  const Vector3d right(20e-3, 1e-3, 3e-3);
  EXPECT_NEAR(field.sample(right, 1).radius, 8e-3, 1e-9);  // another patch, the same radius
  for (double z = 0; z < 40e-3; z += 1e-3) {
    const Ball ball{{20e-3, 0, z}, 3e-3};
    if (!field.is_free(ball)) continue;
    EXPECT_GT(field.sample(ball.center - Vector3d(0, 0, 3e-3), 1).value, 0);
  }
  field.update(0, right, right);
  EXPECT_NEAR(field.sample(left, 1).radius, 16e-3, 1e-9);
}

TEST(SceneField, SaysWhenKernelOrToolDoNotFitThePoints) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  SceneField other(scene, {.kernel = Kernel::wendland});
  other.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(other.notes(), FieldNote::other_kernel));
  SceneField large(scene, {.tool_radius = 5e-3});
  large.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(large.notes(), FieldNote::tool_too_large));
  SceneField fitting(scene, {.tool_radius = 3e-3});
  fitting.update(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_EQ(fitting.notes(), FieldNote::none);
}

TEST(SceneField, PointsOfNoWeightAreNotThere) {
  Scene scene;
  SurfacePoints points = make_points(plane(0));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.grid.points()[i].x() > 0) points.density_weights[i] = 0;
  }
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back({share(std::move(points)), 1, 1});
  scene.add("plane").publish(std::move(snapshot));
  FieldOptions raw = paper_field(FieldKind::metaball);
  for (const FieldOptions& options : {FieldOptions{}, raw}) {
    SceneField field(scene, options);
    field.update(0, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_TRUE(field.is_free({{40e-3, 0, 0}, 5e-3}));
    EXPECT_EQ(field.sample({40e-3, 0, 0}, 1).support, 0);
  }
}

TEST(Source, RefusesPointsThatAreNotWhole) {
  Scene scene;
  Source& source = scene.add("a");
  const auto refused = [&](const auto& spoil) {
    SurfacePoints points = make_points(plane(0, 4e-3, 2));
    spoil(points);
    auto snapshot = std::make_unique<Snapshot>();
    snapshot->layers.push_back({share(std::move(points)), 1, 1});
    EXPECT_THROW(source.publish(std::move(snapshot)), Error);
  };
  refused([](SurfacePoints& p) { p.cell_reach.clear(); });
  refused([](SurfacePoints& p) { p.normals.pop_back(); });
  refused([](SurfacePoints& p) { p.radii[3] = 0; });
  refused([](SurfacePoints& p) { p.radii[3] = NAN; });
  refused([](SurfacePoints& p) { p.density_weights[0] = -1; });
  refused([](SurfacePoints& p) { p.confidences[0] = 2; });
  refused([](SurfacePoints& p) { p.normals[0].x() = INFINITY; });
  refused([](SurfacePoints& p) { p.end_positions.resize(3); });
  refused([](SurfacePoints& p) { p.origin.y() = NAN; });
}

TEST(Source, RefusesSnapshotsThatMakeNoSense) {
  Scene scene;
  Source& source = scene.add("a");
  auto backwards = still(plane(0));
  backwards->start = 1;
  EXPECT_THROW(source.publish(std::move(backwards)), Error);
  auto hollow = std::make_unique<Snapshot>();
  hollow->layers.push_back({nullptr, 1, 1});
  EXPECT_THROW(source.publish(std::move(hollow)), Error);
  auto many = std::make_unique<Snapshot>();
  many->layers.assign(Snapshot::kMaxLayers + 1, {share(make_points(plane(0, 4e-3, 2))), 1, 1});
  EXPECT_THROW(source.publish(std::move(many)), Error);
  auto heavy = still(plane(0));
  heavy->layers.front().weight_end = -3;
  EXPECT_THROW(source.publish(std::move(heavy)), Error);
  auto endless = still(plane(0));
  endless->end = INFINITY;
  EXPECT_THROW(source.publish(std::move(endless)), Error);
  auto unsure = still(plane(0));
  unsure->presence_end = NAN;
  EXPECT_THROW(source.publish(std::move(unsure)), Error);
}

TEST(Scene, RefusesANameTwiceAndTooManySources) {
  Scene scene;
  scene.add("a");
  EXPECT_THROW(scene.add("a"), Error);
  for (std::size_t i = 1; i < Scene::kMaxSources; ++i) scene.add(std::to_string(i));
  EXPECT_THROW(scene.add("one more"), Error);
}

TEST(Scene, ACloudThatCannotBePreparedIsNotAdded) {
  Scene scene;
  EXPECT_THROW(scene.add("nothing", PointCloud{}), Error);
  EXPECT_EQ(scene.size(), 0u);
}

TEST(SceneField, TooManyFieldsAreRefused) {
  Scene scene;
  scene.add("a");
  std::vector<std::unique_ptr<SceneField>> fields;
  for (std::size_t i = 0; i < Handoff<Snapshot>::kReaders; ++i) {
    fields.push_back(std::make_unique<SceneField>(scene));
  }
  EXPECT_THROW(SceneField{scene}, Error);
  fields.pop_back();
  EXPECT_NO_THROW(SceneField{scene});
}

}  // namespace
}  // namespace palpate
