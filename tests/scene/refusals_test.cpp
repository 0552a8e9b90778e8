// Checks the errors of scenes, sources and fields.
#include <gtest/gtest.h>

#include <cmath>

#include "palpate/base/error.hpp"
#include "palpate/scene/scene_field.hpp"
#include "scene/handoff.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using test::make_points;
using test::plane;
using test::share;
using test::still;

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
  auto uncertain = still(plane(0));
  uncertain->presence_end = NAN;
  EXPECT_THROW(source.publish(std::move(uncertain)), Error);
  for (double Snapshot::*time : {&Snapshot::fade, &Snapshot::interval, &Snapshot::spare,
                                 &Snapshot::stamp, &Snapshot::silent_from}) {
    auto timeless = still(plane(0));
    (*timeless).*time = NAN;
    EXPECT_THROW(source.publish(std::move(timeless)), Error);
  }
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
