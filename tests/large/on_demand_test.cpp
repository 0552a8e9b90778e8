// A large cloud that is prepared while it is touched feels as one that was prepared before.

#include "palpate/scene/on_demand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <utility>

#include "large/hills.hpp"
#include "palpate/contact/proxy.hpp"
#include "palpate/scene/scene_field.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// The same cloud in two scenes: whole, and on demand in blocks a quarter of it wide.
struct Hills {
  Hills() { whole.add("whole", *cloud, part.options); }

  std::shared_ptr<const PointCloud> cloud = hills();
  Begun part{cloud, 0.25};
  Scene whole;
};

TEST(OnDemand, ForcesAreThoseOfTheWholeWhereTheBlockIs) {
  Hills hills;
  EXPECT_LT(hills.part.demand->share(), 1);
  EXPECT_EQ(hills.part.source->report().points_in, hills.cloud->size());
  EXPECT_LT(hills.part.source->report().points_out, hills.cloud->size());
  const Box there = hills.part.source->points()->bounds();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  for (int k = 0; k < 40; ++k) {
    const double x = there.lower.x() + share(random) * there.size().x();
    const double y = there.lower.y() + share(random) * there.size().y();
    const Vector3d place(x, y, height(x, y));
    SceneField all(hills.whole);
    SceneField some(hills.part.scene);
    const Contact expected = press(all, place, 2e-3, 1);
    EXPECT_TRUE(expected.touching);
    EXPECT_EQ(press(some, place, 2e-3, 1).force, expected.force) << place.transpose();
    EXPECT_FALSE(has(some.notes(), FieldNote::not_loaded));
  }
}

TEST(OnDemand, WhatIsMissingIsFreeAndSaysSo) {
  Hills hills;
  SceneField field(hills.part.scene);
  const Contact contact = press(field, {0.05, 0.05, height(0.05, 0.05)}, 2e-3, 1);
  EXPECT_FALSE(contact.touching);
  EXPECT_TRUE(has(field.notes(), FieldNote::not_loaded));
}

TEST(OnDemand, WhatToolsComeNearComesFirstAndPushesNobody) {
  Hills hills;
  SceneField field(hills.part.scene);
  const double x = 0.05;
  const Vector3d hip(x, x, height(x, x) - 3e-3);  // under what is not there yet
  Proxy proxy;
  proxy.reset(hip);
  double time = 1;
  double largest = 0;
  bool came = false;
  for (int k = 0; k < 1000; ++k, time += 1e-3) {
    field.update(time, hip, proxy);
    largest = std::max(largest, proxy.step(field, hip, 1e-3).force.norm());
    came = came || !has(field.notes(), FieldNote::not_loaded);
    if (k % 20 == 0 && !came) hills.part.demand->advance(*hills.part.source, time);
  }
  EXPECT_TRUE(came);
  EXPECT_LT(hills.part.demand->share(), 0.7);
  EXPECT_LT(largest, 0.05);  // N
}

TEST(OnDemand, AHandThatPressesFeelsNothingOfWhatArrives) {
  Hills hills;
  SceneField field(hills.part.scene);
  const Vector3d place = hills.part.source->points()->bounds().center();
  const Vector3d hip(place.x(), place.y(), height(place.x(), place.y()) - 2e-3);
  Proxy proxy;
  proxy.reset(hip + Vector3d(0, 0, 0.01));
  Vector3d held = Vector3d::Zero();
  double largest = 0;  // change of the force, N
  double time = 1;
  for (int k = 0; k < 3000; ++k, time += 1e-3) {
    const double lift = std::max(0., 0.01 - 1e-4 * k);
    field.update(time, hip + Vector3d(0, 0, lift), proxy);
    const Vector3d force = proxy.step(field, hip + Vector3d(0, 0, lift), 1e-3).force;
    if (k == 500) held = force;
    if (k > 500) largest = std::max(largest, (force - held).norm());
    if (k > 500 && k % 20 == 0) hills.part.demand->advance(*hills.part.source, time);
  }
  EXPECT_TRUE(hills.part.demand->done());
  EXPECT_GT(held.norm(), 0.5);
  EXPECT_LT(largest, 1e-6);
}

TEST(OnDemand, BecomesTheWhole) {
  Hills hills;
  while (!hills.part.demand->done()) hills.part.demand->advance(*hills.part.source, 1);
  EXPECT_EQ(hills.part.demand->share(), 1);
  const SurfacePoints& some = *hills.part.source->points();
  const SurfacePoints& all = *hills.whole.source(0).points();
  EXPECT_TRUE(std::ranges::equal(some.grid.points(), all.grid.points()));
  EXPECT_EQ(some.normals, all.normals);
  EXPECT_EQ(some.radii, all.radii);
  EXPECT_EQ(some.density_weights, all.density_weights);
  EXPECT_EQ(some.segments.segment, all.segments.segment);
  EXPECT_EQ(hills.part.source->report().points_out, hills.whole.source(0).report().points_out);
  SceneField field(hills.part.scene);
  const Contact contact = press(field, {0.05, 0.05, height(0.05, 0.05)}, 2e-3, 1);
  EXPECT_TRUE(contact.touching);
  EXPECT_FALSE(has(field.notes(), FieldNote::not_loaded));
}

/// What lies beyond a seam is not seen yet: it goes on what is decided on this side.
TEST(OnDemand, AHandBeneathTheSurfaceMeetsNoWallWhereBlocksMeet) {
  Hills hills;
  for (double y = 0.11; y < 0.9; y += 0.05) {
    SceneField field(hills.whole);
    Proxy proxy;
    double largest = 0;
    double time = 1;
    for (double x = 0.1; x < 0.9; x += 5e-4) {
      const Vector3d hip(x, y, height(x, y) - 1e-3);
      if (x == 0.1) proxy.reset(hip);
      field.update(time += 1e-3, hip, proxy);
      largest = std::max(largest, proxy.step(field, hip, 1e-3).force.norm());
    }
    EXPECT_LT(largest, 0.5) << y;  // N
  }
}

TEST(OnDemand, NothingIsPublishedOnceItIsCancelled) {
  Hills hills;
  const auto before = hills.part.source->points();
  hills.part.demand->cancel();
  for (int k = 0; k < 40; ++k) hills.part.demand->advance(*hills.part.source, 1);
  EXPECT_TRUE(hills.part.demand->done());
  EXPECT_EQ(hills.part.source->points(), before);
}

TEST(OnDemand, WhatIsMissingSaysSoHoweverFarAwayItIs) {
  Begun begun(hills(), 0.05);  // some four hundred blocks
  SceneField field(begun.scene);
  double time = 1;
  for (const double x : {0.02, 0.2, 0.8, 0.98}) {
    const Vector3d place(x, x, height(x, x));
    field.update_from(time += 1e-3, place, place);
    EXPECT_TRUE(has(field.notes(), FieldNote::not_loaded)) << x;
  }
}

TEST(OnDemand, BlocksForWhichThereIsNoRoomKeepNobodyWaiting) {
  SourceOptions options;
  options.prepare.estimate_normals = false;  // that is faster, and says as much
  // 225 000 points a block: two fill what is shown at most.
  Begun begun(hills(950), 0.5, options);
  SceneField field(begun.scene);
  double time = 1;
  const auto stay = [&](double y, double seconds) {
    const Vector3d hip(0.36, y, height(0.36, y) + 2e-3);
    for (const double end = time + seconds; time < end; time += 1e-3)
      field.update_from(time, hip, hip);
  };
  stay(0.02, 0.03);
  for (int k = 0; k < 3; ++k) {
    begun.demand->advance(*begun.source, time);
    stay(0.02, 0.15);
  }
  // Then to where three blocks are near, one of which the tool can reach.
  for (double y = 0.02; y < 0.36; y += 1e-4) stay(y, 1e-3);
  for (int k = 0; k < 40 && !begun.demand->done(); ++k) {
    begun.demand->advance(*begun.source, time);
    stay(0.36, 0.15);
  }
  EXPECT_TRUE(begun.demand->done());
}

TEST(OnDemand, SuitsCloudsThatAPersonWouldWaitFor) {
  PrepareOptions options;
  EXPECT_FALSE(OnDemand::suits(*hills(250), options));
  const auto cloud = hills(260);
  EXPECT_TRUE(OnDemand::suits(*cloud, options));
  options.clip = Box{{0.4, 0.4, -1}, {0.6, 0.6, 1}};
  EXPECT_FALSE(OnDemand::suits(*cloud, options));
}

TEST(OnDemand, IsPreparedBesideAHandUntilSomebodyElseSetsTheSource) {
  Hills hills;
  SceneField field(hills.part.scene);
  std::atomic<double> time{1};
  std::jthread preparing([&] {
    while (!hills.part.demand->done()) hills.part.demand->advance(*hills.part.source, time);
  });
  std::jthread other([&] {
    while (hills.part.demand->share() < 0.5) std::this_thread::yield();
    hills.part.demand->cancel();
    hills.part.source->set(*hills.cloud);
  });
  Proxy proxy;
  proxy.reset({0.5, 0.5, 0.1});
  const auto step = [&](double x) {
    const Vector3d hip(x, 0.5, height(x, 0.5) - 2e-3);
    field.update(time, hip, proxy);
    EXPECT_TRUE(proxy.step(field, hip, 1e-3).force.allFinite());
    time = time + 1e-3;
  };
  for (int k = 0; k < 2000; ++k) step(0.1 + 4e-4 * k);
  preparing.join();
  other.join();
  EXPECT_EQ(hills.part.demand->share(), 1);
  EXPECT_EQ(hills.part.source->points()->size(), hills.whole.source(0).points()->size());
  step(0.5);
  EXPECT_FALSE(has(field.notes(), FieldNote::not_loaded));
}

}  // namespace
}  // namespace palpate
