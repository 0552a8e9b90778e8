// Checks a field at its limits: full patches, far places, values that are not finite.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "field/formulas.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"
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

TEST(SceneField, NonFiniteArgumentsAreHarmless) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  SceneField field(scene);
  const Vector3d nan = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  const Vector3d huge = Vector3d::Constant(1e300);
  field.update_from(0, nan, Vector3d::Zero());
  field.update_from(0, huge, huge);
  EXPECT_TRUE(field.sample(huge).gradient.allFinite());
  EXPECT_EQ(field.sample(nan).support, 0);
  EXPECT_FALSE(field.is_free({nan, 1}));
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(field.sample({0, 0, 1e-3}).value, 1e-3, 1e-9);
}

// More points within R than a patch holds.
void add_dense_plane(Scene& scene) {
  auto dense = plane(0, 0.5e-3, 30);
  for (TestPoint& p : dense) p.radius = 30e-3;
  scene.add("plane").publish(still(dense));
}

TEST(SceneField, AnOverfullPatchIsThinnedAndSaysSo) {
  Scene scene;
  add_dense_plane(scene);
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::thinned));
  EXPECT_LE(field.patch_points(), SceneField::kPatchPoints);
  EXPECT_NEAR(field.sample({0, 0, 1e-3}).value, 1e-3, 1e-9);
}

// Its surface is another one: a proxy that jumps there has not been pulled by its hand.
TEST(SceneField, APatchThatIsNoLongerThinnedIsAChange) {
  Scene scene;
  add_dense_plane(scene);
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  ASSERT_TRUE(has(field.notes(), FieldNote::thinned));
  const std::uint64_t before = field.traits().revision;
  field.update_from(1e-3, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_EQ(field.traits().revision, before);
  const Vector3d aside(0.045, 0, 0);
  field.update_from(2e-3, aside, aside);
  ASSERT_FALSE(has(field.notes(), FieldNote::thinned)) << field.patch_points();
  EXPECT_GT(field.traits().revision, before);
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
    field.update_from(0, high, high);
    EXPECT_GT(field.sample(high).value, 0);
    EXPECT_TRUE(field.is_free({high, 0.4}));
    EXPECT_GT(field.traits().resolution, 0);
    EXPECT_NEAR(field.sample({0, 0, 2e-3}).value, 2e-3 - tool, 1e-9);
  }
  source.publish([] {
    auto nothing = std::make_unique<Snapshot>();
    nothing->layers.push_back({share(make_points({})), 1, 1});
    return nothing;
  }());
  SceneField field(scene, {.tool_radius = 1e-3});
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::no_surface));
  EXPECT_TRUE(field.is_free({Vector3d::Zero(), 1}));
}

TEST(SceneField, ATimeThatIsNotFiniteLeavesTheSurfaceWhereItWas) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  SceneField field(scene);
  const Vector3d x(0, 0, 1e-3);
  field.update_from(0.5, x, x);
  field.update_from(std::numeric_limits<double>::quiet_NaN(), x, x);
  EXPECT_TRUE(has(field.notes(), FieldNote::time_not_finite));
  EXPECT_NEAR(field.sample(x).value, 1e-3, 1e-9);
  field.update_from(0.501, x, x);
  EXPECT_FALSE(has(field.notes(), FieldNote::time_not_finite));
}

TEST(SceneField, ASnapshotOfAWrongClockDoesNotBlockLaterOnes) {
  Scene scene;
  Source& source = scene.add("plane");
  source.publish(still(plane(0)));
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  source.publish(still(plane(4e-3), 1e9));
  field.update_from(0.01, Vector3d::Zero(), Vector3d::Zero());
  source.publish(still(plane(2e-3), 0.02));
  field.update_from(0.02, Vector3d::Zero(), Vector3d::Zero());
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
    field.update_from(t, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_NEAR(field.surface(Vector3d::Zero()).presence, 1 - 0.5 * std::min(t, 1.0), 1e-12);
  }
}

TEST(SceneField, PointsAndSourcesArePresentTogether) {
  SurfacePoints points = make_points(plane(0));
  points.presences.assign(points.size(), 1);
  points.end_presences.assign(points.size(), 0.5F);
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->end = 1;
  snapshot->presence_start = snapshot->presence_end = 0.5;
  snapshot->layers.push_back({share(std::move(points))});
  Scene scene;
  scene.add("plane").publish(std::move(snapshot));
  SceneField field(scene);
  for (const double t : {0.0, 0.5, 1.0, 2.0}) {
    field.update_from(t, Vector3d::Zero(), Vector3d::Zero());
    const double of_points = 1 - 0.5 * std::min(t, 1.0);
    EXPECT_NEAR(field.surface(Vector3d::Zero()).presence, 0.5 * of_points, 1e-12);
  }
}

TEST(SceneField, OneRadiusForAllIsOneEverywhere) {
  // Left half with small, right half with large radii: the paper takes that of the nearest point.
  auto points = plane(0);
  for (TestPoint& p : points) p.radius = p.position.x() < 0 ? 8e-3 : 16e-3;
  Scene scene;
  scene.add("plane").publish(still(points));
  FieldOptions options = paper_field(FieldOptions::Kind::metaball);
  SceneField field(scene, options);
  const Vector3d left(-20e-3, 0, 5e-3);
  field.update_from(0, left, left);
  EXPECT_NEAR(field.sample(left).radius, 8e-3, 1e-9);
  const Vector3d right(20e-3, 1e-3, 3e-3);
  EXPECT_NEAR(field.sample(right).radius, 8e-3, 1e-9);  // another patch, the same radius
  for (double z = 0; z < 40e-3; z += 1e-3) {
    const Ball ball{{20e-3, 0, z}, 3e-3};
    if (!field.is_free(ball)) continue;
    EXPECT_GT(field.sample(ball.center - Vector3d(0, 0, 3e-3)).value, 0);
  }
  field.update_from(0, right, right);
  EXPECT_NEAR(field.sample(left).radius, 16e-3, 1e-9);
}

TEST(SceneField, SaysWhenKernelOrToolDoNotFitThePoints) {
  Scene scene;
  scene.add("plane").publish(still(plane(0)));
  SceneField other(scene, {.kernel = Kernel::wendland});
  other.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(other.notes(), FieldNote::other_kernel));
  SceneField large(scene, {.tool_radius = 5e-3});
  large.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(large.notes(), FieldNote::tool_too_large));
  SceneField fitting(scene, {.tool_radius = 3e-3});
  fitting.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_EQ(fitting.notes(), FieldNote::none);
}

// A ball as large as a support would touch metaballs where nothing pushes it out.
TEST(SceneField, AToolOfAnySizeIsPushedOutAndCountsForWhatTheSupportCarries) {
  constexpr double kRadius = 10e-3;  // R
  for (const Kernel kernel : {Kernel::wyvill, Kernel::wendland}) {
    Scene scene;
    auto snapshot = std::make_unique<Snapshot>();
    snapshot->layers.push_back({share(make_points(plane(0), kernel)), 1, 1});
    scene.add("plane").publish(std::move(snapshot));
    for (const double threshold : {0.4, 0.1}) {
      const double offset = plane_offset(kernel, threshold);
      for (const double tool : {0.0, 0.1, 0.2, 0.3, 0.5, 0.52, 0.7, 1.0, 3.0}) {
        SceneField field(scene, {.kind = FieldOptions::Kind::metaball,
                                 .kernel = kernel,
                                 .threshold = threshold,
                                 .tool_radius = tool * kRadius});
        const double surface = std::min(offset + tool, 0.85) * kRadius;
        Proxy proxy;
        for (double z = 15e-3; z > 2e-3; z -= 0.1e-3) {
          const Vector3d hip(0.3e-3, 0.4e-3, z);
          field.update(0, hip, proxy);
          const Vector3d force = proxy.step(field, hip, 1e-3).force;
          const Vector3d expected(0, 0, proxy.options().stiffness * std::max(0.0, surface - z));
          EXPECT_LT((force - expected).norm(), 0.1) << threshold << ' ' << tool << " R, " << z;
        }
        EXPECT_EQ(has(field.notes(), FieldNote::tool_too_large),
                  tool > std::min(0.3, 0.85 - offset));
      }
    }
  }
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
  FieldOptions raw = paper_field(FieldOptions::Kind::metaball);
  for (const FieldOptions& options : {FieldOptions{}, raw}) {
    SceneField field(scene, options);
    field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_TRUE(field.is_free({{40e-3, 0, 0}, 5e-3}));
    EXPECT_EQ(field.sample({40e-3, 0, 0}).support, 0);
  }
}

}  // namespace
}  // namespace palpate
