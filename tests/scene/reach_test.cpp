// Checks where fields say that tools can be.
#include <gtest/gtest.h>

#include <thread>

#include "palpate/scene/scene.hpp"
#include "palpate/scene/scene_field.hpp"
#include "scene/tool_reach.hpp"
#include "support/depth_frames.hpp"

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
  const std::jthread writer([&](const std::stop_token& stop) {
    for (int i = 0; !stop.stop_requested(); ++i) {
      const double v = i % 1000;
      board.write(0, {{v, v, v}, v});
    }
  });
  std::vector<Reach> found;
  for (std::size_t seen = 0; seen < 5000; seen += found.size()) {
    board.read(found);
    for (const Reach& reach : found) {
      ASSERT_EQ(reach.center, Vector3d::Constant(reach.radius));
    }
  }
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
  field.update_from(0, {0.03, 0, 0}, {0.03, 0, 0});
  const DepthFrame frame = test::frame_of(test::small_camera(), 0, test::wall(0.5), 1e-4);
  source.push(frame, [] { return 0.0; });
  EXPECT_EQ(source.state().points, source.points()->size());
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
