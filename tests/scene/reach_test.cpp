// Checks where fields say that tools can be.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "scene/tool_reach.hpp"
#include "support/depth_frames.hpp"
#include "support/effort.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

TEST(ReachTable, TellsWhatWasWritten) {
  ReachTable board;
  std::vector<Reach> found{{Vector3d::Ones(), 5}};
  board.read(found);
  EXPECT_TRUE(found.empty());
  board.write(3, {{1, 2, 3}, 0.1});
  board.write(7, {{4, 5, 6}, 0.2});
  board.read(found);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].center, Vector3d(1, 2, 3));
  EXPECT_EQ(found[1].radius, 0.2);
  board.clear(3);
  board.read(found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].center, Vector3d(4, 5, 6));
}

TEST(ReachTable, NeverGivesHalfOfTwo) {
  ReachTable board;
  std::atomic<bool> done{false};
  const std::jthread writer([&] {
    for (int i = 0; !done; ++i) {
      const double v = i % 1000;
      board.write(0, {{v, v, v}, v});
    }
  });
  std::vector<Reach> found;
  for (int i = 0; i < 20000; ++i) {
    board.read(found);
    for (const Reach& reach : found) {
      ASSERT_EQ(reach.center, Vector3d::Constant(reach.radius));
    }
  }
  done = true;
}

// The hand starts from rest and reaches 1 m/s within a frame and the latency.
TEST(ToolReach, HoldsWhereTheHandGoesNext) {
  constexpr double kTick = 1e-3;
  constexpr double kAhead = 2. / 30 + 0.02;
  const auto hand = [](double t) {
    const double s = t < 0.2 ? 0 : t < 0.4 ? 2.5 * (t - 0.2) * (t - 0.2) : 0.1 + (t - 0.4);
    return Vector3d(s, 0, 0);
  };
  ToolReach reach;
  for (double t = 0; t < 1; t += kTick) {
    const Reach ball = reach.update(t, hand(t), hand(t), 1. / 30, 0.02);
    EXPECT_LT((hand(t + kAhead) - ball.center).norm(), ball.radius) << t;
  }
}

TEST(ToolReach, IsSmallAroundAHandThatRests) {
  ToolReach reach;
  Reach ball;
  for (int k = 0; k < 1000; ++k) {
    ball = reach.update(1e-3 * k, Vector3d::Zero(), Vector3d::Zero(), 1. / 30, 0.02);
  }
  EXPECT_LT(ball.radius, 0.1);
  EXPECT_GT(ball.radius, 0.05);
}

TEST(ToolReach, IsAsMuchLargerAsTheHandsMotionIsMagnified) {
  ToolReach plain;
  ToolReach magnified(10);
  for (int k = 0; k < 50; ++k) {
    const Vector3d hand(0.2e-3 * k * k, 0, 0);  // above a hand's fastest from the 13th step on
    const double way = plain.update(1e-3 * k, hand, hand, 1. / 30, 0).radius;
    EXPECT_NEAR(magnified.update(1e-3 * k, 10 * hand, 10 * hand, 1. / 30, 0).radius, 10 * way,
                1e-12);
  }
}

TEST(ToolReach, HoldsHandAndProxy) {
  ToolReach reach;
  const Vector3d hip(0, 0, -0.3);
  const Vector3d proxy(0.1, 0, 0);
  const Reach ball = reach.update(0, hip, proxy, 1. / 30, 0.02);
  EXPECT_LT((hip - ball.center).norm(), ball.radius);
  EXPECT_LT((proxy - ball.center).norm(), ball.radius);
}

TEST(ToolReach, TimesThatMakeNoSenseAreIgnored) {
  ToolReach reach;
  Reach ball = reach.update(5, Vector3d::Zero(), Vector3d::Zero(), 0, 0);
  ball = reach.update(5, Vector3d::Ones(), Vector3d::Zero(), 0, 0);
  ball = reach.update(4, Vector3d::Zero(), Vector3d::Zero(), 0, 0);
  EXPECT_LT(ball.radius, 0.1);
}

TEST(Scene, FieldsTellSourcesWhereTheyFeel) {
  Scene scene;
  SourceOptions options;
  options.T_world_sensor = test::looking_down();
  options.depth.memory = 1;
  Source& source = scene.add("camera", options);
  SceneField field(scene);
  field.update(0, {0.03, 0, 0}, {0.03, 0, 0});
  const DepthFrame frame = test::frame_of(test::small_camera(), 0, test::wall(0.5), 1e-4);
  source.push(frame, [] { return 0.0; });
  EXPECT_EQ(source.state().points, source.points()->size());
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
  PointCloud cloud;
  cloud.viewpoint = Vector3d(0, 0, 1);
  for (int i = -20; i <= 500; ++i) {
    for (int j = -5; j <= 5; ++j) cloud.positions.push_back({4e-3f * i, 4e-3f * j, 0});
  }
  for (int tick = 0; tick < 1200; ++tick) {
    const double now = 1e-3 * tick;
    const Vector3d hand(0.5 * now, 0, 0);
    field.update(now, hand, hand);
    if (tick % 200 == 0) source.push(cloud, now, [=] { return now + 0.01; });
    if (tick <= 250) continue;
    EXPECT_GT(field.sample(hand).support, 0.9) << now;
  }
  EXPECT_LT(source.state().points, cloud.size() * 3 / 4);
}

/// A strip of 2 m, 4 mm apart; half of it is left of x = 0.
PointCloud strip() {
  PointCloud cloud;
  cloud.viewpoint = Vector3d(0, 0, 1);
  for (int i = -250; i <= 250; ++i) {
    for (int j = -5; j <= 5; ++j) cloud.positions.push_back({4e-3f * i, 4e-3f * j, 0});
  }
  return cloud;
}

TEST(Scene, CloudsAreClippedOnceASurfaceCameLate) {
  Scene scene;
  Source& source = scene.add("sensor");
  SceneField field(scene);
  const PointCloud cloud = strip();
  const auto push = [&](double now, double delay) {
    field.update(now, Vector3d::Zero(), Vector3d::Zero());
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
    field.update(now, hand, hand);
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
    field.update(now, Vector3d::Zero(), Vector3d::Zero());
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
  field.update(0, Vector3d::Zero(), Vector3d::Zero());
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
    field.update(now, Vector3d::Zero(), Vector3d::Zero());
    source.push(cloud, now, [=] { return now + 0.01; });
  }
  field.update(0.4, away, away);
  EXPECT_EQ(field.sample(away).support, 0);
  const double near = field.sample({0.01, 0, 0}).value;
  source.keep();
  EXPECT_EQ(source.points()->size(), cloud.size());
  EXPECT_EQ(source.state().points, cloud.size());
  EXPECT_EQ(source.state().overview, nullptr);
  EXPECT_TRUE(source.state().clipped) << "clouds were, until then";
  for (const double later : {0.55, 0.6, 2.0}) {
    field.update(later, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_NEAR(field.sample({0.01, 0, 0}).value, near, 1e-5) << "what was there stays";
  }
  field.update(10, away, away);
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
    field.update(now, Vector3d::Zero(), Vector3d::Zero());
    EXPECT_TRUE(source.push(cloud, now, [=] { return now + 0.01; }));
  }
  const Source::State state = source.state();
  EXPECT_EQ(state.frames, 4u);
  EXPECT_EQ(state.points, 0u);
  ASSERT_EQ(state.overview->size(), cloud.size());
  EXPECT_EQ((state.overview->origin + state.overview->positions[0].cast<double>()).z(), 5);
  field.update(0.35, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_TRUE(has(field.notes(), FieldNote::no_surface));
}

TEST(Scene, RefusesSourcesThatAFieldWouldNeverSee) {
  Scene scene;
  scene.add("early");
  {
    const SceneField field(scene);
    EXPECT_ANY_THROW(scene.add("late"));
  }
  EXPECT_NO_THROW(scene.add("late"));
}

}  // namespace
}  // namespace palpate
