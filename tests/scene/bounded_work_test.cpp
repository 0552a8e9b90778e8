// What a servo step looks at is bounded, and what it had no time for counts as solid.
#include <gtest/gtest.h>

#include <random>

#include "palpate/contact/proxy.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::share;

constexpr std::uint64_t kMostVisits = 2 * SceneField::kStepVisits;  // update() and a step

/// A dense sheet at z = 0, every 12th of whose points has a reach of metres and next to no weight:
/// all cells come near everything, whose points mostly do not.
std::unique_ptr<Snapshot> hostile_sheet(int half, double spacing) {
  std::vector<Eigen::Vector3f> places;
  for (int i = -half; i <= half; ++i) {
    for (int j = -half; j <= half; ++j) {
      places.push_back(Vector3d(spacing * i, spacing * j, 0).cast<float>());
    }
  }
  SurfacePoints points;
  points.grid = CellGrid(places);
  points.normals.assign(points.size(), Eigen::Vector3f::UnitZ());
  points.density_weights.assign(points.size(), 0.15f);
  points.radii.assign(points.size(), static_cast<float>(2.5 * spacing));
  points.confidences.assign(points.size(), 1);
  for (std::size_t i = 0; i < points.size(); i += 12) {
    points.radii[i] = 3;
    points.density_weights[i] = 1e-12f;
  }
  finish(points);
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->layers.push_back({share(std::move(points)), 1, 1});
  return snapshot;
}

TEST(BoundedWork, AStepThatCannotKnowStaysWhereItIs) {
  Scene scene;
  scene.add("sheet").publish(hostile_sheet(250, 2e-3));
  SceneField field(scene);
  Proxy proxy;
  proxy.reset({0, 0, 0.05});
  bool spent = false;
  for (int k = 0; k < 400; ++k) {
    const Vector3d hip(1e-3 * k, 0, 0.05 - 1e-3 * k);
    const std::uint64_t before = field.visits();
    field.update(1e-3 * k, hip, proxy);
    const Contact contact = proxy.step(field, hip, 1e-3);
    EXPECT_LE(field.visits() - before, kMostVisits);
    EXPECT_GT(contact.proxy.z(), -5e-4);
    EXPECT_TRUE(contact.force.allFinite());
    EXPECT_FALSE(has(contact.notes, ContactNote::fault));
    spent = spent || has(field.notes(), FieldNote::work_spent);
  }
  EXPECT_TRUE(spent);
}

TEST(BoundedWork, OutsideOfAStepSamplesAreBoundedOneByOne) {
  Scene scene;
  scene.add("plane").publish(test::still(test::plane(0)));
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  for (int k = 0; k < 2000; ++k) {  // more than a step could gather
    const double x = k % 2 == 0 ? 50e-3 : -50e-3;
    const double y = k % 3 == 0 ? 50e-3 : -50e-3;  // in turns, so that few are kept
    EXPECT_NEAR(field.sample({x, y, 2e-3}).value, 2e-3, 1e-6);
  }
  EXPECT_EQ(field.points_summed(), 0);  // nobody sets it back to 0 outside of steps
  EXPECT_GT(field.visits(), std::uint64_t{SceneField::kStepVisits});
  EXPECT_FALSE(has(field.notes(), FieldNote::work_spent));
}

TEST(BoundedWork, TwoPlacesAwayFromTheToolAreGatheredOnceEach) {
  Scene scene;
  scene.add("plane").publish(test::still(test::plane(0)));
  SceneField field(scene);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  const std::uint64_t before = field.gathers();
  for (int step = 0; step < 3; ++step) {
    field.begin_step();
    for (int k = 0; k < 10; ++k) {
      EXPECT_NEAR(field.sample({k % 2 == 0 ? 50e-3 : -50e-3, 0, 2e-3}).value, 2e-3, 1e-6);
    }
    field.end_step(Vector3d::Zero(), Vector3d::Zero());
  }
  EXPECT_EQ(field.gathers() - before, 2U);
}

/// A sheet that rises by `rise` from one snapshot to the next.
std::unique_ptr<Snapshot> rising(double from, double rise, double start, double duration) {
  SurfacePoints points = test::make_points(test::plane(from));
  for (const auto& p : points.grid.points()) {
    points.end_positions.push_back(p + Eigen::Vector3f(0, 0, static_cast<float>(rise)));
  }
  finish(points);
  auto snapshot = std::make_unique<Snapshot>();
  snapshot->start = start;
  snapshot->end = start + duration;
  snapshot->layers.push_back({share(std::move(points)), 1, 1});
  return snapshot;
}

TEST(BoundedWork, AMovingSurfaceIsGatheredOnceASnapshot) {
  Scene scene;
  Source& source = scene.add("sheet");
  SceneField field(scene);
  Proxy proxy;
  constexpr int kFrames = 10;
  constexpr int kTicks = 33;
  std::uint64_t gathers = 0;
  for (int k = 0; k < kFrames * kTicks; ++k) {
    const double now = 1e-3 * k;
    const int frame = k / kTicks;
    if (k % kTicks == 0) source.publish(rising(1e-3 * frame, 1e-3, now, 0.033));
    const Vector3d hip(2e-3, 1e-3, now / 0.033 * 1e-3 - 2e-3);
    field.update(now, hip, proxy);
    const Contact contact = proxy.step(field, hip, 1e-3);
    if (k == kTicks) gathers = field.gathers();
    if (k > kTicks && contact.touching) {
      EXPECT_NEAR(contact.proxy.z(), now / 0.033 * 1e-3, 2e-5) << now;
    }
  }
  EXPECT_LE(field.gathers() - gathers, 4u * kFrames);
}

}  // namespace
}  // namespace palpate
