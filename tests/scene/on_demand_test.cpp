// A large cloud that is prepared while it is touched feels as one that was prepared before.

#include "palpate/scene/on_demand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

double height(double x, double y) {
  return 0.03 * std::sin(9 * x) * std::cos(7 * y);
}

/// 90 000 points of hills over the unit square.
std::shared_ptr<const PointCloud> hills() {
  std::mt19937 random(5);
  std::normal_distribution<double> error(0, 1);
  auto cloud = std::make_shared<PointCloud>();
  for (int i = 0; i < 300; ++i) {
    for (int j = 0; j < 300; ++j) {
      const double x = (i + 0.1 * error(random)) / 300;
      const double y = (j + 0.1 * error(random)) / 300;
      cloud->positions.push_back(Vector3d(x, y, height(x, y)).cast<float>());
    }
  }
  return cloud;
}

/// The same cloud in two scenes: whole, and on demand in blocks a quarter of it wide.
struct Hills {
  Hills() {
    options.prepare.facts = measure_facts(*cloud, {});
    options.prepare.facts->radius = 0.25 / 96;
    whole.add("whole", *cloud, options);
    demand = std::make_unique<OnDemand>(cloud, options.prepare);
    some = &part.add("part", options);
    while (!some->points()) demand->advance(*some, 0);
  }

  std::shared_ptr<const PointCloud> cloud = hills();
  SourceOptions options;
  Scene whole;
  Scene part;
  Source* some = nullptr;
  std::unique_ptr<OnDemand> demand;
};

/// Lets a hand press at a place for 20 ms.
Contact press(SceneField& field, const Vector3d& place, double depth, double time) {
  Proxy proxy;
  proxy.reset(place + Vector3d(0, 0, 0.01));
  Contact contact;
  for (int k = 0; k < 20; ++k) {
    const Vector3d hip = place + Vector3d(0, 0, 0.01 - (0.01 + depth) * k / 19);
    field.update(time + 1e-3 * k, hip, proxy.position());
    contact = proxy.step(field, hip, 1e-3);
  }
  return contact;
}

TEST(OnDemand, ForcesAreThoseOfTheWholeWhereTheBlockIs) {
  Hills hills;
  EXPECT_LT(hills.demand->share(), 1);
  const Box there = hills.some->points()->bounds();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  for (int k = 0; k < 40; ++k) {
    const double x = there.lower.x() + share(random) * there.size().x();
    const double y = there.lower.y() + share(random) * there.size().y();
    const Vector3d place(x, y, height(x, y));
    SceneField all(hills.whole);
    SceneField some(hills.part);
    const Contact expected = press(all, place, 2e-3, 1);
    EXPECT_TRUE(expected.touching);
    EXPECT_EQ(press(some, place, 2e-3, 1).force, expected.force) << place.transpose();
    EXPECT_FALSE(has(some.notes(), FieldNote::not_loaded));
  }
}

TEST(OnDemand, WhatIsMissingIsFreeAndSaysSo) {
  Hills hills;
  SceneField field(hills.part);
  const Contact contact = press(field, {0.05, 0.05, height(0.05, 0.05)}, 2e-3, 1);
  EXPECT_FALSE(contact.touching);
  EXPECT_TRUE(has(field.notes(), FieldNote::not_loaded));
}

TEST(OnDemand, WhatToolsComeNearComesFirstAndPushesNobody) {
  Hills hills;
  SceneField field(hills.part);
  const double x = 0.05;
  const Vector3d hip(x, x, height(x, x) - 3e-3);  // under what is not there yet
  Proxy proxy;
  proxy.reset(hip);
  double time = 1;
  double largest = 0;
  bool came = false;
  for (int k = 0; k < 1000; ++k, time += 1e-3) {
    field.update(time, hip, proxy.position());
    largest = std::max(largest, proxy.step(field, hip, 1e-3).force.norm());
    came = came || !has(field.notes(), FieldNote::not_loaded);
    if (k % 20 == 0 && !came) hills.demand->advance(*hills.some, time);
  }
  EXPECT_TRUE(came);
  EXPECT_LT(hills.demand->share(), 0.7);
  EXPECT_LT(largest, 0.05);  // N
}

TEST(OnDemand, AHandThatPressesFeelsNothingOfWhatArrives) {
  Hills hills;
  SceneField field(hills.part);
  const Vector3d place = hills.some->points()->bounds().center();
  const Vector3d hip(place.x(), place.y(), height(place.x(), place.y()) - 2e-3);
  Proxy proxy;
  proxy.reset(hip + Vector3d(0, 0, 0.01));
  Vector3d held = Vector3d::Zero();
  double largest = 0;  // change of the force, N
  double time = 1;
  for (int k = 0; k < 3000; ++k, time += 1e-3) {
    const double lift = std::max(0., 0.01 - 1e-4 * k);
    field.update(time, hip + Vector3d(0, 0, lift), proxy.position());
    const Vector3d force = proxy.step(field, hip + Vector3d(0, 0, lift), 1e-3).force;
    if (k == 500) held = force;
    if (k > 500) largest = std::max(largest, (force - held).norm());
    if (k > 500 && k % 20 == 0) hills.demand->advance(*hills.some, time);
  }
  EXPECT_TRUE(hills.demand->done());
  EXPECT_GT(held.norm(), 0.5);
  EXPECT_LT(largest, 1e-6);
}

TEST(OnDemand, BecomesTheWhole) {
  Hills hills;
  while (!hills.demand->done()) hills.demand->advance(*hills.some, 1);
  EXPECT_EQ(hills.demand->share(), 1);
  const SurfacePoints& some = *hills.some->points();
  const SurfacePoints& all = *hills.whole.source(0).points();
  EXPECT_TRUE(std::ranges::equal(some.grid.points(), all.grid.points()));
  EXPECT_EQ(some.normals, all.normals);
  EXPECT_EQ(some.radii, all.radii);
  EXPECT_EQ(some.density_weights, all.density_weights);
  EXPECT_EQ(some.sheets.sheet, all.sheets.sheet);
  EXPECT_EQ(hills.some->report().points_out, hills.whole.source(0).report().points_out);
  SceneField field(hills.part);
  const Contact contact = press(field, {0.05, 0.05, height(0.05, 0.05)}, 2e-3, 1);
  EXPECT_TRUE(contact.touching);
  EXPECT_FALSE(has(field.notes(), FieldNote::not_loaded));
}

TEST(OnDemand, NothingIsPublishedOnceItIsCancelled) {
  Hills hills;
  const auto before = hills.some->points();
  hills.demand->cancel();
  for (int k = 0; k < 40; ++k) hills.demand->advance(*hills.some, 1);
  EXPECT_TRUE(hills.demand->done());
  EXPECT_EQ(hills.some->points(), before);
}

}  // namespace
}  // namespace palpate
