// Friction of tools where the answer has a closed form (docs/method.md 3.7, 4.1).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/field/analytic.hpp"
#include "support/effort.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kStatic = 0.6;
constexpr double kDynamic = 0.4;

ToolOptions rough(double viscous = 0) {
  ToolOptions options = kOptions;
  options.friction = {kStatic, kDynamic, viscous};
  return options;
}

Vector3d along(const ToolContact& contact) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < contact.touch_count; ++i) {
    sum += contact.touches[static_cast<std::size_t>(i)].friction;
  }
  return sum;
}

// Flat on a plane, pushed 4 mm deep (2 N), then dragged: it stays until the hand pulls with
// mu_s of that, and slides with mu_d of it. No torque: the hand pulls at the height of the contact.
TEST(ToolFriction, ABoxOnAPlaneStaysUntilTheConeAndSlidesOnIt) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3, {0, 0, 0.01}), rough());
  static_cast<void>(press(proxy, plane, pose_at({0, 0, 0.01}), pose_at({0, 0, -0.004})));
  const Vector3d rest = proxy.pose().position;
  double yielded = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double pulled = 2e-6 * i;  // m
    const ToolContact contact = proxy.step(plane, pose_at({pulled, 0, -0.004}), kTick);
    ASSERT_NEAR(contact.wrench.force.z(), 2, 1e-7);
    ASSERT_LT(contact.wrench.torque.norm(), 1e-3);
    ASSERT_LT((along(contact) - Vector3d(contact.wrench.force.x(), 0, 0)).norm(), 0.02);
    if (yielded == 0 && contact.sliding) yielded = pulled;
    const double force = yielded > 0 ? 2 * kDynamic : kStiffness * pulled;
    ASSERT_NEAR(contact.wrench.force.x(), -force, 0.02) << i;
    if (yielded == 0) {
      ASSERT_LT((proxy.pose().position - rest).norm(), 1e-6);
    }
  }
  EXPECT_NEAR(yielded * kStiffness, 2 * kStatic, 0.02);
}

// The handle is above the floor, so what holds the tool tips it: others of its samples press than
// without friction.
TEST(ToolFriction, AToolThatIsDraggedByItsHandleIsHeldByItsWholeLoad) {
  const PlaneField plane;
  for (const char* name : {"box:20x20x20", "box:40x60x20", "cylinder:20x10", "gripper:8x12x16"}) {
    for (const double spacing : {2.5e-3, 5e-3}) {
      ToolProxy proxy = proxy_of(Tool::from_text(name, spacing), rough());
      const double height = name[0] == 'g' ? 0.016 : 0.01;
      static_cast<void>(
          press(proxy, plane, pose_at({0, 0, height + 1e-3}), pose_at({0, 0, height - 3e-3})));
      ToolContact contact;
      int sliding = 0;
      for (int i = 1; i <= 400; ++i) {
        contact = proxy.step(plane, pose_at({2e-5 * i, 0, height - 3e-3}), kTick);
        sliding += i > 200 && contact.sliding ? 1 : 0;
      }
      EXPECT_GT(sliding, 100) << name;
      EXPECT_NEAR(contact.wrench.force.z(), 1.5, 1e-6) << name;
      EXPECT_NEAR(contact.wrench.force.x(), -1.5 * kDynamic, 0.02 * 1.5 * kDynamic) << name;
      EXPECT_LT(std::abs(contact.wrench.force.y()), 0.1 * 1.5 * kDynamic) << name;
    }
  }
}

// A flat ring of samples around the handle, turned about its axis: it holds mu times force times
// radius.
TEST(ToolFriction, ARingHoldsATwistUpToItsRadius) {
  const PlaneField plane;
  const double radius = 0.02;
  std::vector<Tool::Point> ring;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    ring.push_back({{radius * std::cos(angle), radius * std::sin(angle), 0}, 0, 0});
  }
  ToolProxy proxy = proxy_of(Tool(ring), rough());
  static_cast<void>(press(proxy, plane, pose_at({0, 0, 0.01}), pose_at({0, 0, -0.004})));
  ToolContact contact;
  for (int i = 1; i <= 4000; ++i) {
    contact = proxy.step(plane, pose_at({0, 0, -0.004}, {0, 0, 2e-4 * i}), kTick);
    if (contact.sliding) continue;
    ASSERT_NEAR(contact.wrench.torque.z(), -kTurnStiffness * 2e-4 * i, 1e-5);
  }
  EXPECT_TRUE(contact.sliding);
  EXPECT_NEAR(contact.wrench.torque.z(), -kDynamic * 2 * radius, 1e-5);
}

// A sample at the handle is a point, whose friction is that of Proxy.
TEST(ToolFriction, APointToolIsAProxyInEveryTick) {
  const PlaneField plane;
  for (const double viscous : {0.0, 2.0}) {
    ProxyOptions options;
    options.stiffness = kStiffness;
    options.friction = {kStatic, kDynamic, viscous};
    Proxy point(options);
    ToolProxy proxy = proxy_of(Tool({{{0, 0, 0}, 0, 0}}), rough(viscous));
    proxy.reset(pose_at({0, 0, 0.01}));
    point.reset({0, 0, 0.01});
    int slides = 0;
    int touched = 0;  // ticks
    for (int i = 0; i < 6000; ++i) {
      const double t = kTick * i;
      const Vector3d hand(0.02 * std::sin(2 * t), 0.01 * std::sin(3.1 * t), 2e-3 * std::cos(t));
      const ToolContact contact = proxy.step(plane, pose_at(hand), kTick);
      const Contact truth = point.step(plane, hand, kTick);
      const double off = (contact.wrench.force - truth.force).norm();
      touched = truth.touching ? touched + 1 : 0;
      // What is viscous counts the step's motion from its beginning here, from the entry there.
      const bool settles = viscous > 0 && touched < 50;
      ASSERT_LT(off, settles ? 5e-3 : 1e-6) << "tick " << i;
      ASSERT_EQ(contact.sliding, truth.sliding) << "tick " << i;
      slides += truth.sliding ? 1 : 0;
    }
    EXPECT_GT(slides, 500);
  }
}

// A hand that pulls within the cone for twenty seconds moves a tilted box by no more than 10 um.
TEST(ToolFriction, ABoxThatIsPulledWithinTheConeStaysForever) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, 5e-3), rough());
  static_cast<void>(press(proxy, plane, pose_at({0, 0, 0.02}), pose_at({0, 0, 0.006})));
  const Pose hand = pose_at({0.9 * kStatic * 0.004, 0, 0.006}, {0.01, 0.02, 0.01});
  for (int i = 0; i < 100; ++i) static_cast<void>(proxy.step(plane, hand, kTick));
  const Vector3d rest = proxy.pose().position;
  ToolContact contact;
  for (int i = 0; i < 20'000; ++i) contact = proxy.step(plane, hand, kTick);
  EXPECT_FALSE(contact.sliding);
  EXPECT_LT(contact.wrench.force.x(), -1);
  EXPECT_LT((proxy.pose().position - rest).norm(), 1e-5);
}

// Hands that wander in closed paths get nothing from rough edges and corners.
TEST(ToolFriction, ClosedPathsGiveNoEnergy) {
  const TorusField torus(0.05, 0.02);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const Tool& tool : four_tools()) {
    ToolProxy proxy = proxy_of(tool, rough(0.5));
    const int loops = effort(15);
    for (int loop = 0; loop < loops; ++loop) {
      const auto draw = [&](double size) {
        return Vector3d(size * normal(random), size * normal(random), size * normal(random));
      };
      const Vector3d middle = Vector3d(0.06, 0, 0.02) + draw(0.005);
      const std::array<Vector3d, 4> amplitudes{draw(0.01), draw(0.01), draw(0.3), draw(0.3)};
      const auto hand = [&](double phase) {
        return pose_at(
            middle + std::sin(phase) * amplitudes[0] + (std::cos(phase) - 1) * amplitudes[1],
            std::sin(phase) * amplitudes[2] + std::sin(2 * phase) * amplitudes[3],
            0.02 + 0.005 * std::sin(phase));
      };
      const Metric metric{proxy.options().gyration};
      double given = 0;   // J
      double stored = 0;  // in the spring, where the second round begins
      proxy.reset(hand(0));
      Pose before = hand(0);
      Wrench wrench;
      for (int i = 1; i <= 4000; ++i) {  // the second half goes the same path again
        const Pose now = hand(2 * std::numbers::pi * i / 2000);
        const ToolContact contact = proxy.step(torus, now, kTick);
        ASSERT_TRUE(contact.wrench.force.allFinite());
        if (i == 2000)
          stored = 0.5 * contact.stiffness * metric.between(now, contact.proxy).squaredNorm();
        if (i > 2000) {
          given += 0.5 * (wrench.force + contact.wrench.force).dot(now.position - before.position);
          given += 0.5 * (wrench.torque + contact.wrench.torque)
                             .dot(turn_between(before.orientation, now.orientation));
          given += 0.5 * (wrench.grip + contact.wrench.grip) * (now.opening - before.opening);
        }
        wrench = contact.wrench;
        before = now;
      }
      EXPECT_LT(given - stored, 1e-4) << "loop " << loop;
    }
  }
}

TEST(ToolFriction, IsRefusedOutOfRange) {
  for (const Friction& wrong : {Friction{-1, 0, 0}, Friction{0.2, 0.3, 0}, Friction{0, 0, -1}}) {
    ToolOptions options;
    options.friction = wrong;
    EXPECT_THROW(static_cast<void>(proxy_of(Tool::ball(0.01), options)), Error);
  }
}

}  // namespace
}  // namespace palpate::test
