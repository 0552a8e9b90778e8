// Where there is nothing, or nothing any more: empty fields, fog, surfaces that vanish and come
// back, steps that take no time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact/test_fields.hpp"
#include "palpate/field/analytic.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

TEST(ToolInNothing, GoesWhereTheHandIs) {
  const EmptyField empty;
  for (Tool& tool : four_tools()) {
    ToolProxy proxy = proxy_of(std::move(tool));
    const double most = proxy.tool().opens() ? 0.02 : 0;
    for (int i = 0; i < 200; ++i) {
      const Pose hand = pose_at({0.1 * std::sin(0.3 * i), 0, 0}, {0, 0.1 * i, 0}, most);
      const ToolContact contact = proxy.step(empty, hand, kTick);
      EXPECT_EQ(contact.proxy.position, hand.position);
      EXPECT_EQ(contact.wrench.force, Vector3d(0, 0, 0));
      EXPECT_EQ(contact.wrench.torque, Vector3d(0, 0, 0));
      EXPECT_EQ(contact.notes, ContactNote::none);
      EXPECT_FALSE(contact.touching);
    }
  }
}

// Fog from the first step on: nobody knows whether the tool is outside, so nothing holds it. It
// says so, and spends no more than it may.
TEST(ToolInNothing, FogFromTheFirstStepHoldsNothing) {
  const FogField fog;
  ToolProxy proxy = proxy_of(Tool::box({0.02, 0.03, 0.01}, 5e-3), {.stiffness = 500});
  for (int i = 0; i < 100; ++i) {
    const Pose hand = pose_at({1e-4 * i, 0, 0.05});
    const ToolContact contact = proxy.step(fog, hand, kTick);
    EXPECT_TRUE(has(contact.notes, ContactNote::sweep_truncated));
    EXPECT_TRUE(has(contact.notes, ContactNote::inside));
    EXPECT_EQ(contact.proxy.position, hand.position);
    EXPECT_EQ(contact.wrench.force, Vector3d(0, 0, 0));
    EXPECT_LE(contact.evaluations, proxy.max_evaluations());
  }
}

/// A plane that can vanish.
class VanishingPlaneField final : public Field {
 public:
  bool gone = false;
  std::uint64_t revision = 0;

  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    return gone ? Sample{.value = 1} : plane_.sample(x);
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return gone || plane_.is_free(ball);
  }
  [[nodiscard]] Surface surface(const Vector3d& x) const noexcept override {
    return plane_.surface(x);
  }
  [[nodiscard]] Traits traits() const noexcept override {
    Traits traits = plane_.traits();
    traits.revision = revision;
    return traits;
  }

 private:
  PlaneField plane_{{.reanchor_reach = 0.02}};
};

// Nothing waits: the tool is at the hand at once. A surface that comes back around it lifts it out,
// and no force is above what it was: stiffness comes with the hand's motion.
TEST(ToolInNothing, ASurfaceVanishesAndComesBack) {
  VanishingPlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), kOptions);
  const Pose hand = pose_at({0, 0, 0.006});
  const ToolContact before = press(proxy, plane, pose_at({0, 0, 0.05}), hand);
  EXPECT_NEAR(before.wrench.force.z(), 2, 1e-9);
  for (int round = 0; round < 3; ++round) {
    plane.gone = true;
    ++plane.revision;
    ToolContact contact = proxy.step(plane, hand, kTick);
    EXPECT_EQ(contact.proxy.position, hand.position);
    EXPECT_FALSE(contact.touching);
    for (int i = 0; i < 300; ++i) contact = proxy.step(plane, hand, kTick);
    EXPECT_EQ(contact.wrench.force, Vector3d(0, 0, 0));
    plane.gone = false;
    ++plane.revision;
    double largest = 0;
    for (int i = 0; i < 300; ++i) {
      contact = proxy.step(plane, hand, kTick);
      largest = std::max(largest, contact.wrench.force.norm());
    }
    EXPECT_NEAR(contact.proxy.position.z(), 0.01, 1e-4);
    EXPECT_LE(largest, 2.1);
    EXPECT_LT(depth_of(proxy, plane), 0.02 * kSupport);
  }
}

// Bounds are forgotten after a kilometre; what comes then is met as exactly.
TEST(ToolInNothing, AToolThatHasComeFarMeetsASurface) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), kOptions);
  for (int i = 0; i < 40; ++i) {
    (void)proxy.step(plane, pose_at({i % 2 == 0 ? 0 : 50.0, 0, 100}), kTick);
  }
  for (double height = 100; height > 0.013; height *= 0.7) {
    (void)proxy.step(plane, pose_at({0, 0, height}), kTick);
  }
  ToolContact contact;
  for (int i = 0; i < 400; ++i) {
    contact = proxy.step(plane, pose_at({0, 0, std::max(0.006, 0.012 - 1e-4 * i)}), kTick);
  }
  EXPECT_NEAR(contact.wrench.force.z(), 2, 1e-9);
}

// A step that takes no time moves the tool, too: the same force, nothing that is not finite.
TEST(ToolInNothing, AStepOfNoTimeIsAStep) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), kOptions);
  proxy.reset(pose_at({0, 0, 0.05}));
  ToolContact contact;
  for (int i = 0; i < 500; ++i) {
    contact = proxy.step(plane, pose_at({0, 0, std::max(0.006, 0.05 - 1e-4 * i)}), 0);
    EXPECT_FALSE(has(contact.notes, ContactNote::fault));
  }
  EXPECT_NEAR(contact.wrench.force.z(), 2, 1e-9);
  EXPECT_LT(contact.wrench.torque.norm(), 1e-9);
}

// More than half a turn is taken the short way round: the torque flips, and is finite.
TEST(ToolInNothing, MoreThanHalfATurnIsTakenTheShortWay) {
  const SheetField sheet;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.01, 0.04}, 5e-3), kOptions);
  proxy.reset(pose_at({0, 0, 0.04}));
  double largest = 0;
  for (int i = 0; i < 4000; ++i) {
    const double height = std::max(0.021, 0.04 - 1e-4 * i);
    const ToolContact contact = proxy.step(sheet, pose_at({0, 0, height}, {0, 2e-3 * i, 0}), kTick);
    EXPECT_TRUE(contact.wrench.torque.allFinite());
    EXPECT_LE(contact.wrench.torque.norm(), 3.15 * kTurnStiffness);
    EXPECT_LT(depth_of(proxy, sheet), 0.02 * kSupport);
    largest = std::max(largest, contact.wrench.torque.norm());
  }
  EXPECT_GT(largest, 0.02);
}

/// Solid below z = 0, and points up to R above and below it, as a cloud has them.
class NearPlaneField final : public Field {
 public:
  [[nodiscard]] Sample sample(const Vector3d& x) const noexcept override {
    if (std::abs(x.z()) >= kSupport) return {.value = 1};
    return {.value = x.z(), .gradient = Vector3d::UnitZ(), .support = 1, .radius = kSupport};
  }
  [[nodiscard]] bool is_free(const Ball& ball) const noexcept override {
    return std::abs(ball.center.z()) > ball.radius + kSupport;
  }
  [[nodiscard]] Surface surface(const Vector3d&) const noexcept override { return {}; }
  [[nodiscard]] Traits traits() const noexcept override { return {.resolution = 6e-4}; }
};

// The largest ball that is promised to be held, and a stylus of such, by hands as fast as 0.5 m/s.
TEST(ToolNearPoints, ABallOfThreeTenthsOfTheRadiusIsHeld) {
  const NearPlaneField plane;
  for (const double pace : {1e-5, 1e-4, 5e-4}) {
    for (Tool tool : {Tool::ball(3e-3), Tool::capsule(0.03, 3e-3, 5e-3)}) {
      ToolProxy proxy = proxy_of(std::move(tool));
      double deepest = 0;
      double height = 0.05;
      ToolContact contact;
      for (; height > 1e-3; height -= pace) {
        contact = proxy.step(plane, pose_at({0, 0, height}, {1.57, 0, 0}), kTick);
        deepest = std::max(deepest, 3e-3 - proxy.pose().position.z());
      }
      EXPECT_LT(deepest, 0.02 * kSupport) << pace;
      EXPECT_TRUE(contact.touching);
    }
  }
}

}  // namespace
}  // namespace palpate::test
