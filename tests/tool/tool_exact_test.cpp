// docs/method.md 3.7 where the answer has a closed form, or a search that knows nothing of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "base/numbers.hpp"
#include "contact/test_fields.hpp"
#include "palpate/field/analytic.hpp"
#include "support/effort.hpp"
#include "tool/tool_rig.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

// A stick that lies along x with its tip a length away: the tip stays at height 0, and the handle
// comes up and turns by t about -y so that K (d - l sin t) l cos t = K g^2 t.
TEST(ToolOnPlane, OneContactTurnsALever) {
  const PlaneField plane;
  for (const double length : {0.01, 0.03, 0.08, 0.2}) {
    for (const double depth : {0.002, 0.006}) {
      ToolProxy proxy = proxy_of(Tool({{{length, 0, 0}, 0, 0}}), kOptions);
      const ToolContact contact =
          press(proxy, plane, pose_at({0, 0, 0.01}), pose_at({0, 0, -depth}));
      double t = 0;
      double low = 0;
      double high = std::asin(std::min(1.0, depth / length));
      for (int i = 0; i < 100; ++i) {
        t = 0.5 * (low + high);
        const double lever = (depth - length * std::sin(t)) * length * std::cos(t);
        (lever > kGyration * kGyration * t ? low : high) = t;
      }
      const double force = kStiffness * (depth - length * std::sin(t));
      EXPECT_LT((contact.wrench.force - Vector3d(0, 0, force)).norm(), 1e-7);
      EXPECT_LT((contact.wrench.torque - Vector3d(0, -kTurnStiffness * t, 0)).norm(), 1e-8);
      ASSERT_EQ(contact.touch_count, 1);
      EXPECT_NEAR(contact.touches[0].force, force, 1e-7);
    }
  }
}

/// The largest errors of a box that slides flat on a plane, over all ticks.
struct Errors {
  double force = 0;   // N
  double torque = 0;  // N m
  double depth = 0;   // m
  int touching = 0;   // ticks
};

Errors errors_sliding_flat(double spacing) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::box({0.04, 0.06, 0.02}, spacing), kOptions);
  proxy.reset(pose_at({0, 0, 0.02}));
  Errors worst;
  for (int i = 0; i < 4000; ++i) {
    const double t = kTick * i;
    const double depth = 0.005 * std::sin(4 * t);  // of the lower face
    const Pose hand = pose_at({0.03 * std::sin(3 * t), 0.02 * t, 0.01 - depth}, {0, 0, t});
    const ToolContact contact = proxy.step(plane, hand, kTick);
    const Vector3d truth(0, 0, kStiffness * std::max(0.0, depth));
    worst.force = std::max(worst.force, (contact.wrench.force - truth).norm());
    worst.torque = std::max(worst.torque, contact.wrench.torque.norm());
    worst.depth = std::max(worst.depth, depth_of(proxy, plane));
    worst.touching += contact.touching ? 1 : 0;
  }
  return worst;
}

TEST(ToolOnPlane, ABoxThatSlidesFlatFeelsNoTorqueInAnyTick) {
  const Errors worst = errors_sliding_flat(5e-3);
  EXPECT_LT(worst.force, 1e-9);
  EXPECT_LT(worst.torque, 1e-11);
  EXPECT_LT(worst.depth, 1e-11);
  EXPECT_GT(worst.touching, 1500);
}

// Twice as many samples touch as the solver takes constraints: it takes turns between them.
TEST(ToolOnPlane, MoreSamplesThanConstraintsLoseLittle) {
  const Errors worst = errors_sliding_flat(1.5e-3);
  EXPECT_LT(worst.force, 0.1);
  EXPECT_LT(worst.torque, 5e-3);
  EXPECT_LT(worst.depth, 2e-4);
  EXPECT_GT(worst.touching, 1500);
}

/// The energy of a tool's springs over a plane, when it is turned by w from the hand and stands as
/// low as it can.
double energy_turned(const Tool& tool, const Pose& hand, const Vector3d& w) {
  const Eigen::Quaterniond orientation = turned(hand.orientation, w);
  double lowest = 0;
  for (const Tool::Point& each : tool.samples()) {
    lowest = std::min(lowest, (orientation * each.position).z());
  }
  const double rise = std::max(0.0, -lowest - hand.position.z());
  return 0.5 * kStiffness * (rise * rise + kGyration * kGyration * w.squaredNorm());
}

/// The turn of least energy that a random search finds from here.
Vector3d search_from(const Tool& tool, const Pose& hand, const Vector3d& start, Random& random) {
  Vector3d best = start;
  double least = energy_turned(tool, hand, best);
  for (double step = 0.2; step > 1e-8; step *= 0.7) {
    for (int k = 0; k < 100; ++k) {
      const Vector3d w = best + 2 * step *
                                    Vector3d(random.uniform() - 0.5, random.uniform() - 0.5,
                                             random.uniform() - 0.5);
      if (const double energy = energy_turned(tool, hand, w); energy < least) {
        least = energy;
        best = w;
      }
    }
  }
  return best;
}

Vector3d random_vector(Random& random) {
  return {2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1};
}

TEST(ToolOnPlane, ATiltedBoxHasTheLeastEnergyOfAllTurns) {
  const PlaneField plane;
  Random random(3);
  const Tool tool = Tool::box({0.04, 0.06, 0.02}, 0.01);
  for (int i = 0; i < std::max(4, effort(20)); ++i) {
    const Vector3d tilt = 0.5 * random_vector(random);
    const Pose hand = pose_at({0, 0, 0.006 + 0.006 * random_vector(random).z()}, tilt);
    ToolProxy proxy = proxy_of(tool, kOptions);
    const ToolContact contact = press(proxy, plane, pose_at({0, 0, 0.06}, tilt), hand, 200, 1500);
    const Vector3d mine = turn_between(hand.orientation, contact.proxy.orientation);
    const double rise = contact.proxy.position.z() - hand.position.z();
    const double energy =
        0.5 * kStiffness * (rise * rise + kGyration * kGyration * mine.squaredNorm());
    Vector3d best = search_from(tool, hand, mine, random);
    for (int start = 0; start < 3; ++start) {
      const Vector3d other = search_from(tool, hand, 0.5 * random_vector(random), random);
      if (energy_turned(tool, hand, other) < energy_turned(tool, hand, best)) best = other;
    }
    const double least = energy_turned(tool, hand, best);
    EXPECT_LT(std::abs(energy - least), 1e-6 * std::max(least, 1e-6)) << i;
    EXPECT_LT((contact.wrench.torque - kTurnStiffness * best).norm(), 1e-6) << i;
  }
}

// A hand that is deeper in the solid around a bowl than the bowl is wide: whole motions along the
// tangent plane would swing from side to side.
TEST(ToolInABowl, ADeepHandIsHeldAtItsClosestPoint) {
  const BowlField bowl(0.02);
  for (const double depth : {0.01, 0.03, 0.06}) {
    ToolProxy proxy = proxy_of(Tool({{{0, 0, 0}, 0, 0}}), kOptions);
    const double away = 0.02 + depth;
    (void)press(proxy, bowl, pose_at({0, 0, 0}), pose_at({away, 0, 0}), 300, 0);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const double angle = 1e-3 * std::min(i, 1000);
      const Vector3d out(std::cos(angle), std::sin(angle), 0);
      const ToolContact contact = proxy.step(bowl, pose_at(away * out), kTick);
      const Vector3d truth = -kStiffness * depth * out;
      worst = std::max(worst, (contact.wrench.force - truth).norm());
    }
    EXPECT_LT(worst, 0.02) << depth;
    const Vector3d end(std::cos(1), std::sin(1), 0);
    EXPECT_LT((proxy.pose().position - 0.02 * end).norm(), 1e-7) << depth;
  }
}

// An angle hung over the edge of a block: one leg lies on its top, the other on its side. While the
// torques that both legs can bear are not exceeded it does not give way, whatever the hand does.
TEST(ToolOverAnEdge, AnAngleIsHeldByBothLegs) {
  const BoxField block({0.1, 0.1, 0.1},
                       {.T_world_shape = Eigen::Isometry3d(Eigen::Translation3d(-0.05, 0, -0.05))});
  std::vector<Tool::Point> samples;
  for (int i = 1; i <= 8; ++i) {
    for (const double y : {-0.01, 0.0, 0.01}) {
      samples.push_back({{-5e-3 * i, y, 0}, 0, 0});  // on top, 5 to 40 mm from the edge
      samples.push_back({{0, y, -5e-3 * i}, 0, 0});  // beside it
    }
  }
  ToolProxy proxy = proxy_of(Tool(std::move(samples)), kOptions);
  const Vector3d out(0.005, 0, 0.005);
  (void)press(proxy, block, pose_at(out), pose_at(Vector3d::Zero()));
  double force = 0;
  double torque = 0;
  for (int i = 0; i < 2000; ++i) {
    const double t = kTick * i;
    // 3 N and 2 N, at levers of 5 to 40 mm: they bear -120 to 80 mN m and more about y.
    const Vector3d inside(-0.004 - 0.002 * std::sin(7 * t), 0, -0.005 - 0.001 * std::cos(5 * t));
    const Vector3d turn(0.01 * std::sin(3 * t), 0.03 * std::sin(2 * t), 0.01 * std::cos(3 * t));
    const ToolContact contact = proxy.step(block, pose_at(inside, turn), kTick);
    force = std::max(force, (contact.wrench.force + kStiffness * inside).norm());
    torque = std::max(torque, (contact.wrench.torque + kTurnStiffness * turn).norm());
  }
  EXPECT_LT(force, 1e-7);
  EXPECT_LT(torque, 1e-9);
  // Beyond what they bear it gives way: 0.8 rad are 360 mN m.
  for (const double turn : {-0.8, 0.8}) {
    Pose hand = pose_at({-0.004, 0, -0.005});
    ToolContact contact;
    for (int i = 0; i < 2000; ++i) {
      hand.orientation =
          turned(Eigen::Quaterniond::Identity(), {0, turn * std::min(1.0, 1e-3 * i), 0});
      contact = proxy.step(block, hand, kTick);
    }
    const Vector3d given = turn_between(Eigen::Quaterniond::Identity(), contact.proxy.orientation);
    EXPECT_GT(given.y() / turn, 0.2);
    for (int i = 2000; i > 0; --i) {
      hand.orientation = turned(Eigen::Quaterniond::Identity(), {0, turn * 5e-4 * i, 0});
      (void)proxy.step(block, hand, kTick);
    }
  }
}

}  // namespace
}  // namespace palpate::test
