// A tool that is put inside of what is solid, or across it: it comes out at once, or is not held.

#include <gtest/gtest.h>

#include <random>

#include "palpate/field/analytic.hpp"
#include "tool/held_tool.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// A box is put across a closed cloud's top at random depths and turns, rests there and is lifted.
// Nothing holds it; when it comes back it is on top.
TEST(ToolBegins, AcrossABallItIsNotHeld) {
  Scene scene;
  scene.add("ball", cloud_of(ball({.jitter = 0.2}, 0.04)));
  std::mt19937 random(20261130);
  std::uniform_real_distribution<double> angle(-0.3, 0.3);
  for (int k = 0; k < 12; ++k) {
    HeldTool held(scene, Tool::box({0.02, 0.01, 0.03}, 2.5e-3));
    const double depth = 1.5e-3 + 2e-3 * k;
    const double roll = angle(random);
    const Vector3d turn(roll, angle(random), 0);
    const Vector3d start(0, 0, 0.04 + 0.015 - depth);
    held.reset(pose_at(start, turn));
    double largest = 0;
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
      const double up = 1e-4 * std::max(0, i - 50);
      const ToolContact contact = held.step(pose_at(start + Vector3d(0, 0, up), turn));
      largest = std::max(largest, contact.wrench.force.norm());
      inside += has(contact.notes, ContactNote::inside) ? 1 : 0;
    }
    EXPECT_LT(largest, 0.2) << k;      // held, a hand lifted so far would feel 17 N
    const int least = k > 4 ? 40 : 0;  // less deep, one step may lead it out
    EXPECT_GE(inside, least) << k;
    EXPECT_EQ((held.pose().position - start).x(), 0) << k;
    held.to(pose_at(start + Vector3d(0, 0, 0.035), turn), 1, 0);
    const ToolContact contact = held.to(pose_at(start, turn), 300, 50);
    EXPECT_GT(contact.wrench.force.z(), 0.3 * kStiffness * depth) << k;
  }
}

// The same of a tool that was pressed onto it from outside and is reset where the hand is.
TEST(ToolBegins, AResetUnderALoadLetsGo) {
  Scene scene;
  scene.add("ball", cloud_of(ball({.jitter = 0.2}, 0.04)));
  for (Tool& tool : four_tools()) {
    HeldTool held(scene, std::move(tool));
    const auto hand = [](double z) { return pose_at({0, 0, z}, Vector3d::Zero(), 0.01); };
    held.reset(hand(0.12));
    double z = 0.12;
    while (z > 0 && held.step(hand(z)).wrench.force.norm() < 2) z -= 1e-4;
    ASSERT_GT(z, 0);
    held.reset(hand(z));
    double largest = 0;
    for (int i = 0; i < 800; ++i) {
      largest =
          std::max(largest, held.step(hand(z + 1e-4 * std::max(0, i - 100))).wrench.force.norm());
    }
    EXPECT_LT(largest, 0.2);
    EXPECT_EQ(held.pose().position, hand(z + 1e-4 * 699).position);
  }
}

// A cloud that comes around a tool which was in an empty scene is a beginning, too.
TEST(ToolBegins, ACloudThatComesAroundItDoesNotHoldIt) {
  Scene scene;
  Source& source = scene.add("ball");
  HeldTool held(scene, Tool::box({0.02, 0.01, 0.03}, 2.5e-3));
  const Vector3d start(0, 0, 0.049);
  held.reset(pose_at(start));
  for (int i = 0; i < 50; ++i) held.step(pose_at(start));
  source.set(cloud_of(ball({.jitter = 0.2}, 0.04)));
  double largest = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d lifted = start + Vector3d(0, 0, 1e-4 * i);
    largest = std::max(largest, held.step(pose_at(lifted)).wrench.force.norm());
  }
  EXPECT_LT(largest, 0.2);
}

// A tool that is put where it lay, on a face or a little in it, lies there again.
TEST(ToolBegins, WhereItLayItLiesAgain) {
  Scene scene;
  scene.add("ball", cloud_of(ball({.jitter = 0.2}, 0.04)));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-1, 1);
  for (int k = 0; k < 20; ++k) {
    HeldTool held(scene, Tool::box({0.02, 0.03, 0.01}, 2.5e-3));
    const double roll = angle(random);
    const Vector3d turn(roll, angle(random), 0);
    held.reset(pose_at({0, 0, 0.1}, turn));
    double z = 0.1;
    while (z > 0 && held.step(pose_at({0, 0, z}, turn)).wrench.force.norm() < 0.05) z -= 1e-4;
    ASSERT_GT(z, 0);
    held.reset(pose_at({0, 0, z}, turn));
    int inside = 0;
    for (int i = 0; i < 30; ++i) {
      const ToolContact contact = held.step(pose_at({0, 0, z}, turn));
      inside += has(contact.notes, ContactNote::inside) ? 1 : 0;
    }
    EXPECT_EQ(inside, 0) << k;
  }
}

// A cavity is free: a tool that begins in it touches its wall from inside.
TEST(ToolBegins, InsideACavityItFeelsTheWall) {
  Scene scene;
  scene.add("ball", cloud_of(ball({.jitter = 0.2}, 0.06)));
  HeldTool held(scene, Tool::box({0.02, 0.02, 0.02}, 2.5e-3));
  held.reset(pose_at({0, 0, 0}));
  EXPECT_FALSE(has(held.step(pose_at({0, 0, 0})).notes, ContactNote::inside));
  const ToolContact contact = held.to(pose_at({0, 0, 0.055}), 600, 100);
  EXPECT_LT(contact.wrench.force.z(), -2);
  EXPECT_LT(held.depth(), 0.02);
}

// Deep inside a solid, from where one step does not lead out, it touches nothing until it is out.
TEST(ToolBegins, DeepInASolidItTouchesNothing) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), kOptions);
  const auto hand = [](int i) { return pose_at({0, 0, -0.05 + 1e-4 * i}); };
  for (int i = 0; i < 350; ++i) {
    const ToolContact contact = proxy.step(plane, hand(i), kTick);
    EXPECT_TRUE(has(contact.notes, ContactNote::inside)) << i;
    EXPECT_EQ(contact.wrench.force, Vector3d(0, 0, 0)) << i;
    EXPECT_EQ(contact.proxy.position, hand(i).position) << i;
  }
  for (int i = 350; i < 620; ++i) (void)proxy.step(plane, hand(i), kTick);
  const ToolContact contact = press(proxy, plane, hand(620), pose_at({0, 0, 0.007}));
  EXPECT_NEAR(contact.wrench.force.z(), 3e-3 * kStiffness, 1e-6);
}

}  // namespace
}  // namespace palpate::test
