// A cloud that is prepared together is touched in blocks until it is there.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stop_token>
#include <thread>

#include "large/hills.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Lets it go on at `time` until the whole fades in, and then until that is through.
void change_over(Begun& begun, double time) {
  for (int k = 0; k < 1000 && begun.demand->advance(*begun.source, time); ++k) continue;
  EXPECT_FALSE(begun.demand->done());
  EXPECT_FALSE(begun.demand->advance(*begun.source, time + 0.05)) << "while the fade lasts";
  EXPECT_TRUE(begun.demand->advance(*begun.source, time + 0.2));
}

TEST(ChangeOver, WhatCanBePreparedTogetherIsInTheEnd) {
  const auto cloud = hills();
  Begun begun(cloud);
  EXPECT_LT(begun.source->points()->size(), cloud->size() / 2);
  Scene scene;
  scene.add("whole", *cloud, {});
  const Vector3d place(0.5, 0.5, height(0.5, 0.5));
  SceneField some(begun.scene);
  SceneField all(scene);
  const double early = press(some, place, 2e-3, 1).force.norm();
  change_over(begun, 2);
  EXPECT_TRUE(begun.demand->done());
  EXPECT_EQ(begun.demand->share(), 1);
  const Contact expected = press(all, place, 2e-3, 3);
  EXPECT_EQ(press(some, place, 2e-3, 3).force, expected.force);
  EXPECT_NEAR(early, expected.force.norm(), 0.01 * expected.force.norm());
  EXPECT_EQ(begun.source->points()->radii, scene.source(0).points()->radii);
  EXPECT_EQ(begun.source->report().points_in, cloud->size());
}

TEST(ChangeOver, WhatIsNotThereYetIsSeenAllOverTheCloud) {
  Begun begun(hills());
  const auto overview = begun.source->state().overview;
  ASSERT_NE(overview, nullptr);
  const Box there = begun.source->points()->bounds();
  const Vector3d edge = Vector3d(0.01, 0.01, 0);
  const Box inner{there.lower + edge, there.upper - edge};
  Box seen;
  for (std::size_t i = 0; i < overview->size(); ++i) {
    seen.extend(overview->point(i));
    EXPECT_FALSE(inner.contains(overview->point(i)));
  }
  EXPECT_GT(seen.size().x(), 0.99);
  EXPECT_GT(seen.size().y(), 0.99);
  change_over(begun, 2);
  EXPECT_EQ(begun.source->state().overview, nullptr);
}

TEST(ChangeOver, AHandThatPressesFeelsNoStepWhereTheWholeTakesThePlaceOfBlocks) {
  Begun begun(hills());
  SceneField field(begun.scene);
  const Vector3d hip = Vector3d(0.5, 0.5, height(0.5, 0.5)) - Vector3d(0, 0, 3e-3);
  Proxy proxy;
  proxy.reset(hip + Vector3d(0, 0, 0.01));
  double time = 1;
  Vector3d last = Vector3d::Zero();
  double most = 0;
  const auto step = [&](const Vector3d& hand) {
    field.update(time += 1e-3, hand, proxy);
    const Contact contact = proxy.step(field, hand, 1e-3);
    EXPECT_TRUE(contact.touching || hand != hip);
    most = hand == hip ? std::max(most, (contact.force - last).norm()) : 0;
    last = contact.force;
  };
  for (int k = 0; k <= 50; ++k) step(hip + Vector3d(0, 0, 0.01 - 0.0002 * k));
  for (int k = 0; k < 100; ++k) step(hip);
  most = 0;
  for (int k = 0; k < 5000 && !begun.demand->done(); ++k) {
    begun.demand->advance(*begun.source, time);
    step(hip);
  }
  EXPECT_TRUE(begun.demand->done());
  for (int k = 0; k < 100; ++k) step(hip);
  EXPECT_GT(last.norm(), 1);
  EXPECT_LT(most, 0.01);  // N: far below what a finger feels
}

TEST(ChangeOver, AllIsShownBeforeAllIsPreparedTogether) {
  Begun begun(hills());
  SceneField field(begun.scene);
  double time = 1;
  while (begun.demand->share() < 0.5) begun.demand->advance(*begun.source, time += 0.2);
  EXPECT_EQ(begun.source->points()->size(), 90'000u);
  EXPECT_FALSE(begun.demand->done());
  EXPECT_LT(begun.demand->share(), 1);
  const Vector3d corner(0.05, 0.05, height(0.05, 0.05));
  EXPECT_GT(press(field, corner, 2e-3, time + 1).force.norm(), 0.5);
}

TEST(ChangeOver, CanBeLeftWhileAllIsPreparedTogether) {
  Begun begun(hills());
  std::stop_source stopped;
  stopped.request_stop();
  double time = 1;
  const auto go_on = [&] {
    begun.demand->advance(*begun.source, time += 0.2, true, stopped.get_token());
  };
  while (begun.demand->share() < 0.5) go_on();
  for (int k = 0; k < 3; ++k) go_on();
  EXPECT_FALSE(begun.demand->done());
  EXPECT_EQ(begun.demand->share(), 0.5);
  change_over(begun, time + 1);
  EXPECT_TRUE(begun.demand->done());
}

TEST(ChangeOver, IsCancelledFromAnotherThread) {
  Begun begun(hills());
  std::jthread other([&] { begun.demand->cancel(); });
  double time = 1;
  for (int k = 0; k < 1000 && begun.demand->advance(*begun.source, time); ++k) time += 0.2;
  other.join();
  EXPECT_TRUE(begun.demand->done());
  EXPECT_FALSE(begun.demand->advance(*begun.source, time + 1));
}

TEST(ChangeOver, WhatAnEyeSawHoldsTowardsItFromTheFirstBlockOn) {
  const auto cloud = hills();
  SourceOptions options;
  options.prepare.viewpoint = Vector3d(0.5, 0.5, 1);
  Scene scene;
  scene.add("whole", *cloud, options);
  const auto& expected = scene.source(0).points()->eye;
  ASSERT_TRUE(expected);
  Begun begun(cloud, options);
  ASSERT_TRUE(begun.source->points()->eye);
  EXPECT_EQ(begun.source->points()->eye->position, expected->position);
  change_over(begun, 2);
  ASSERT_TRUE(begun.source->points()->eye);
}

}  // namespace
}  // namespace palpate
