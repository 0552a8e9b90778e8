// Checks clouds that are clipped to where tools can be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A strip along x, 4 mm apart, from the `first` to the `last` point: 2 m, half of it left of x =
/// 0.
PointCloud strip(int first = -250, int last = 250) {
  PointCloud cloud;
  cloud.viewpoint = Vector3d(0, 0, 1);
  for (int i = first; i <= last; ++i) {
    for (int j = -5; j <= 5; ++j) cloud.positions.push_back({4e-3f * i, 4e-3f * j, 0});
  }
  return cloud;
}

// A hand that moves at 0.5 m/s over clouds that come five times a second, each clipped to where it
// can be: it never comes to their end.
TEST(Scene, CloudsAreClippedToWhereTheHandCanBe) {
  if (test::effort(2) < 2) GTEST_SKIP() << "too long where every test is to be quick";
  SourceOptions options;
  options.policy.policy = Policy::average;
  options.policy.history = 1;
  options.policy.clip_to_reach = true;
  Scene scene;
  Source& source = scene.add("sensor", options);
  SceneField field(scene);
  const PointCloud cloud = strip(-20, 500);
  for (int tick = 0; tick < 1200; ++tick) {
    const double now = 1e-3 * tick;
    const Vector3d hand(0.5 * now, 0, 0);
    field.update_from(now, hand, hand);
    if (tick % 200 == 0) source.push(cloud, now, [=] { return now + 0.01; });
    if (tick <= 250) continue;
    EXPECT_GT(field.sample(hand).support, 0.9) << now;
  }
  EXPECT_LT(source.state().points, cloud.size() * 3 / 4);
}

TEST(Scene, CloudsAreClippedOnceASurfaceCameLate) {
  Scene scene;
  Source& source = scene.add("sensor");
  SceneField field(scene);
  const PointCloud cloud = strip();
  const auto push = [&](double now, double delay) {
    field.update_from(now, Vector3d::Zero(), Vector3d::Zero());
    source.push(cloud, now, [=] { return now + delay; });
    return source.state();
  };
  for (const double now : {0.0, 0.1, 0.2}) {
    EXPECT_EQ(push(now, kLateCloud - 0.01).points, cloud.size()) << now;
    EXPECT_EQ(source.state().overview, nullptr);
  }
  for (const double now : {0.3, 0.5, 0.7}) {
    EXPECT_EQ(push(now, kLateCloud + 0.01).points, cloud.size()) << "no more than three are enough";
  }
  const Source::State clipped = push(0.9, 0.01);
  EXPECT_LT(clipped.points, cloud.size() * 3 / 4);
  ASSERT_NE(clipped.overview, nullptr);
  EXPECT_EQ(clipped.points + clipped.overview->size(), cloud.size());
  source.change(source.options());
  EXPECT_EQ(push(1.0, 0.01).points, cloud.size()) << "other options may be quicker";
}

/// Ticks of 2 s in which a hand finds nothing under itself that moves at `speed` (m/s) over clouds
/// that come each `interval` (s), 0.12 s late.
int ticks_without_surface(double interval, double speed) {
  Scene scene;
  Source& source = scene.add("sensor");
  SceneField field(scene);
  const PointCloud cloud = strip();
  double next = 0;
  int lost = 0;
  const double begin = 5 * interval;  // clipped by then
  for (int tick = 0; tick < static_cast<int>(1e3 * (begin + 2)); ++tick) {
    const double now = 1e-3 * tick;
    const Vector3d hand(-0.5 + speed * std::max(0.0, now - begin), 0, 0);
    field.update_from(now, hand, hand);
    if (now >= next) source.push(cloud, now, [=] { return now + 0.12; });
    if (now >= next) next += interval;
    if (now > begin && !(field.sample(hand).support > 0.1)) ++lost;
  }
  EXPECT_LT(source.state().points, cloud.size());
  return lost;
}

TEST(Scene, ClippedCloudsOfASlowSensorReachAsFarAsTheyHaveToLast) {
  for (const double interval : {0.1, 0.25, 0.5}) {
    EXPECT_EQ(ticks_without_surface(interval, 0.3), 0) << interval;
  }
}

// A sensor of 30 Hz whose whole clouds take 0.6 s, and parts of them as much less.
TEST(Scene, ClippedCloudsOfAQuickSensorAreQuickAtOnce) {
  Scene scene;
  Source& source = scene.add("sensor");
  SceneField field(scene);
  const PointCloud cloud = strip();
  double now = 0;
  double delay = 0.6;
  for (int k = 0; k < 12; ++k) {
    field.update_from(now, Vector3d::Zero(), Vector3d::Zero());
    source.push(cloud, now, [&] { return now + delay; });
    EXPECT_LT(delay, k > 3 ? 0.15 : 0.61) << k;
    now = std::ceil(30 * (now + delay)) / 30;
    const auto points = static_cast<double>(source.state().points);
    delay = 0.6 * points / static_cast<double>(cloud.size());
  }
}

TEST(Scene, WhatIsLeftOutOfClippedCloudsIsWhatPreparationWouldTake) {
  SourceOptions options;
  options.policy.clip_to_reach = true;
  options.prepare.clip = Box{Vector3d(0.6, -1, -1), Vector3d(2, 1, 1)};
  Scene scene;
  Source& source = scene.add("sensor", options);
  SceneField field(scene);
  PointCloud cloud = strip();
  const auto in_box = std::ranges::count_if(cloud.positions, [](auto& p) { return p.x() >= 0.6f; });
  cloud.positions.emplace_back(std::nanf(""), 0, 0);
  field.update_from(0, Vector3d::Zero(), Vector3d::Zero());
  source.push(cloud, 0, [] { return 0.01; });
  EXPECT_EQ(source.state().points, 0u);
  EXPECT_EQ(source.state().overview->size(), static_cast<std::size_t>(in_box));
}

TEST(Scene, LastCloudOfAClippedStreamStaysWhole) {
  SourceOptions options;
  options.policy.clip_to_reach = true;
  Scene scene;
  Source& source = scene.add("sensor", options);
  SceneField field(scene);
  const PointCloud cloud = strip();
  const Vector3d away(0.9, 0, 0);
  for (const double now : {0.0, 0.1, 0.2, 0.3}) {
    field.update_from(now, Vector3d::Zero(), Vector3d::Zero());
    source.push(cloud, now, [=] { return now + 0.01; });
  }
  field.update_from(0.4, away, away);
  EXPECT_EQ(field.sample(away).support, 0);
  const double near = field.sample({0.01, 0, 0}).value;
  source.keep();
  EXPECT_EQ(source.points()->size(), cloud.size());
  EXPECT_EQ(source.state().points, cloud.size());
  EXPECT_EQ(source.state().overview, nullptr);
  EXPECT_TRUE(source.state().clipped) << "clouds were, until then";
  for (const double later : {0.55, 0.6, 2.0}) {
    field.update_from(later, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_NEAR(field.sample({0.01, 0, 0}).value, near, 1e-5) << "what was there stays";
  }
  field.update_from(10, away, away);
  EXPECT_GT(field.sample(away).support, 0.9);
}

TEST(Scene, ClippedCloudsWithoutAPointInReachAreEmptySurfaces) {
  SourceOptions options;
  options.policy.clip_to_reach = true;
  options.T_world_sensor = Eigen::Translation3d(0, 0, 5) * Eigen::Isometry3d::Identity();
  Scene scene;
  Source& source = scene.add("sensor", options);
  SceneField field(scene);
  const PointCloud cloud = strip();
  for (const double now : {0.0, 0.1, 0.2, 0.3}) {
    field.update_from(now, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_TRUE(source.push(cloud, now, [=] { return now + 0.01; }));
  }
  const Source::State state = source.state();
  EXPECT_EQ(state.frames, 4u);
  EXPECT_EQ(state.points, 0u);
  ASSERT_EQ(state.overview->size(), cloud.size());
  EXPECT_EQ((state.overview->origin + state.overview->positions[0].cast<double>()).z(), 5);
  field.update_from(0.35, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::no_surface));
}

}  // namespace
}  // namespace palpate
