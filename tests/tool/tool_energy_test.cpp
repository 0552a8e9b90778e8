// A tool gives a hand no energy, whatever it touches and however it is turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>

#include "palpate/field/analytic.hpp"
#include "tool/tool_rig.hpp"
#include "tool/tool_spring.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

/// The work that a wrench does on a hand while it moves from one pose to another, J.
double work_of(const Wrench& before, const Wrench& after, const Pose& from, const Pose& to) {
  return 0.5 * ((before.force + after.force).dot(to.position - from.position) +
                (before.torque + after.torque).dot(turn_between(from.orientation, to.orientation)) +
                (before.grip + after.grip) * (to.opening - from.opening));
}

/// What a closed path gives a hand, once the tool has gone round it before.
struct Round {
  double given = 0;                                        // J
  double least = std::numeric_limits<double>::infinity();  // force, N
};

Round go_round(ToolProxy& proxy, const Field& field, const std::function<Pose(double)>& hand_at) {
  constexpr int kTicks = 3000;  // of a round
  Round round;
  Pose from = hand_at(0);
  Wrench before;
  for (int i = 0; i <= 2 * kTicks; ++i) {
    const Pose to = hand_at(static_cast<double>(i) / kTicks);
    const Wrench now = proxy.step(field, to, kTick).wrench;
    if (i > kTicks) round.given += work_of(before, now, from, to);
    round.least = std::min(round.least, now.force.norm());
    before = now;
    from = to;
  }
  return round;
}

// Where the hand moves in from outside, 3 mm after the tool has come to touch.
Pose pressed_on(ToolProxy& proxy, const Field& field) {
  Pose hand = pose_at({0.15, 0, 0}, Vector3d::Zero(), 0.01);
  proxy.reset(hand);
  int touching = 0;
  while (touching < 30) {
    hand.position.x() -= 1e-4;
    touching += proxy.step(field, hand, kTick).touching ? 1 : 0;
  }
  return hand;
}

constexpr double kRound = 2 * std::numbers::pi;

// Along and around the outside of a torus, turning, without falling off anywhere: what goes in
// comes out.
TEST(ToolEnergy, AClosedPathOnATorusGivesNothingAndTakesNothing) {
  const TorusField torus(0.05, 0.02);
  for (Tool& tool : four_tools()) {
    ToolProxy proxy = proxy_of(std::move(tool));
    const Pose pressed = pressed_on(proxy, torus);
    const auto hand_at = [&pressed](double t) {
      const double once = std::sin(kRound * t);
      const double twice = std::sin(2 * kRound * t);
      const double other = 1 - std::cos(kRound * t);
      const Vector3d moved = pressed.position + 1e-3 * Vector3d(twice, 2 * other, 3 * once);
      const Eigen::Quaterniond around = turned(Eigen::Quaterniond::Identity(), {0, 0, 0.5 * once});
      Pose hand = pressed;
      hand.position = around * moved;
      hand.orientation = around * turned(pressed.orientation, 0.05 * Vector3d(twice, once, other));
      return hand;
    };
    const Round round = go_round(proxy, torus, hand_at);
    EXPECT_LT(std::abs(round.given), 5e-5);
    EXPECT_GT(round.least, 0.3);
  }
}

// Through and around the tube, deep inside: the tool falls over edges, which takes energy.
TEST(ToolEnergy, AClosedPathThroughATorusGivesNothing) {
  const TorusField torus(0.05, 0.02);
  for (Tool& tool : four_tools()) {
    ToolProxy proxy = proxy_of(std::move(tool));
    (void)pressed_on(proxy, torus);
    const Round round = go_round(proxy, torus, [](double t) {
      const double angle = kRound * t;
      const double rho = 0.05 + 0.019 * std::cos(3 * angle);
      const Vector3d position(rho * std::cos(angle), rho * std::sin(angle),
                              0.019 * std::sin(3 * angle));
      return pose_at(position, {0.4 * std::sin(2 * angle), 0.3 * std::cos(angle), angle}, 0.01);
    });
    EXPECT_LT(round.given, 5e-5);
  }
}

// A surface that is found elsewhere takes the tool 20 mm away from a hand that has moved by 0.1 mm:
// the spring begins with what that would have put into one at rest.
TEST(ToolEnergy, ASpringThatJumpsBeginsWithWhatTheHandGave) {
  const Metric metric{kGyration};
  ToolSpring spring;
  ToolContact contact;
  spring.pull({.hand = pose_at({0, 0, 0}),
               .before = pose_at({0, 0, 0}),
               .now = pose_at({0, 0, 0.02}),
               .full = kStiffness,
               .moved = 1e-4,
               .dt = kTick,
               .touching = true,
               .jumped = true},
              metric, contact);
  EXPECT_GT(contact.stiffness, 0);
  EXPECT_LE(0.5 * contact.stiffness * 0.02 * 0.02, 0.5 * kStiffness * 1e-4 * 1e-4 * (1 + 1e-9));
}

// A tool that is moved sideways 30 times a second, beside a hand that rests, keeps its stiffness:
// no jump makes the spring longer.
TEST(ToolEnergy, JumpsThatStretchNothingCostNothing) {
  const Metric metric{kGyration};
  ToolSpring spring;
  ToolContact contact;
  double side = 2e-3;  // m
  for (int i = 0; i < 3200; ++i) {
    const Pose before = pose_at({side, 0, 0.01});
    const bool jumps = i > 0 && i < 3000 && i % 33 == 0;
    if (jumps) side = -side;
    contact = {};
    spring.pull({.hand = pose_at({0, 0, i == 0 ? 0.01 : 0}),
                 .before = before,
                 .now = pose_at({side, 0, 0.01}),
                 .full = kStiffness,
                 .moved = i == 0 ? 1.0 : 0.0,
                 .dt = kTick,
                 .touching = true,
                 .jumped = jumps},
                metric, contact);
  }
  EXPECT_GT(contact.stiffness, 0.95 * kStiffness);
}

/// What a tool on a floor gives to a hand in a time, J.
struct Given {
  double by_force = 0;
  double by_torque = 0;
};

/// A handle of 0.1 kg that is pressed down with 1 N and damped, with a stick of 80 mm whose wrist
/// saws by `swing` (rad) at 3 Hz. The torque is computed and not felt.
Given given_to_wrist(double swing, int ticks) {
  const PlaneField plane;
  ToolProxy proxy = proxy_of(Tool::capsule(0.08, 0.003, 1e-3), {.gyration = 0.03});
  Pose hand = pose_at({0, 0, 0.09});
  proxy.reset(hand);
  Given given;
  Wrench before;
  double velocity = 0;  // m/s, up
  for (int i = 0; i < ticks; ++i) {
    const Pose from = hand;
    const double push = before.force.z() - 1 - 2 * velocity;  // N
    velocity += kTick * push / 0.1;
    hand.position.z() += kTick * velocity;
    hand = pose_at(hand.position, {swing * std::sin(2 * std::numbers::pi * 3 * kTick * i), 0, 0});
    const Wrench now = proxy.step(plane, hand, kTick).wrench;
    Wrench force = now;
    force.torque.setZero();
    Wrench force_before = before;
    force_before.torque.setZero();
    const double by_force = work_of(force_before, force, from, hand);
    given.by_force += by_force;
    given.by_torque += work_of(before, now, from, hand) - by_force;
    before = now;
  }
  return given;
}

// A wrist that is not moved lifts the handle by the force alone, and would be held by the torque.
TEST(ToolEnergy, WhatAWristSawsUpItsTorqueWouldTake) {
  const Given sawing = given_to_wrist(0.5, 20'000);
  EXPECT_GT(sawing.by_force, 0.05);
  EXPECT_LE(sawing.by_force + sawing.by_torque, 0);
  const Given still = given_to_wrist(0, 60'000);
  EXPECT_LE(still.by_force + still.by_torque, 1e-3);
}

}  // namespace
}  // namespace palpate::test
