#include <gtest/gtest.h>

#include "contact/drive.hpp"
#include "contact/probe.hpp"
#include "palpate/field/analytic.hpp"

namespace palpate::test {
namespace {

using Eigen::Vector3d;

constexpr double kFrictionDepth = 0.003;

Proxy pressed(const Field& field, const Friction& friction) {
  Proxy proxy{{.friction = friction}};
  proxy.reset({0, 0, 0.01});
  drive(proxy, field, {0, 0, 0.01}, {0, 0, -kFrictionDepth}, 0.1);
  return proxy;
}

struct Drag : testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(Drag, TangentialForceIsMuTimesNormalForce) {
  const auto [mu, speed] = GetParam();
  const PlaneField plane;
  Proxy proxy = pressed(plane, {.static_coefficient = mu, .dynamic_coefficient = mu});
  const Vector3d from(0, 0, -kFrictionDepth);
  const Vector3d along = Vector3d(3, 4, 0) / 5;
  drive(proxy, plane, from, from + 0.02 * along, speed);
  drive(proxy, plane, from + 0.02 * along, from + 0.1 * along, speed,
        [along, friction = mu](const Vector3d&, const Contact& c) {
          EXPECT_TRUE(c.sliding);
          EXPECT_NEAR(-c.force.dot(along) / c.force.z(), friction, 1e-3 * friction);
        });
}

INSTANTIATE_TEST_SUITE_P(MuAndSpeed, Drag,
                         testing::Combine(testing::Values(0.1, 0.3, 0.6, 1.2),
                                          testing::Values(0.005, 0.02, 0.2, 1.0)));

TEST(Friction, HoldsBelowTheStaticLimitAndGivesWayAboveIt) {
  const PlaneField plane;
  const Friction friction{.static_coefficient = 0.5, .dynamic_coefficient = 0.3};
  Proxy proxy = pressed(plane, friction);
  const double limit = 0.5 * kFrictionDepth;
  Contact held =
      drive(proxy, plane, {0, 0, -kFrictionDepth}, {0.999 * limit, 0, -kFrictionDepth}, 0.01);
  held = rest(proxy, plane, {0.999 * limit, 0, -kFrictionDepth}, 500);
  EXPECT_FALSE(held.sliding);
  EXPECT_EQ(held.proxy.x(), 0);
  const Contact slid = proxy.step(plane, {1.001 * limit, 0, -kFrictionDepth}, kTick);
  EXPECT_TRUE(slid.sliding);
  EXPECT_NEAR(-slid.force.x() / slid.force.z(), 0.3, 1e-3);
  const Contact stuck = proxy.step(plane, {1.001 * limit, 0, -kFrictionDepth}, kTick);
  EXPECT_FALSE(stuck.sliding);
}

// A hand of 200 N/m and 1 N s/m draws a mass of 0.1 kg along; returns slips a second.
double slips_at(double speed) {
  const PlaneField plane;
  Proxy proxy = pressed(plane, {.static_coefficient = 0.6, .dynamic_coefficient = 0.3});
  constexpr int kSteps = 4000;
  double x = 0;
  double velocity = 0;
  int slips = 0;
  bool was_sliding = false;
  for (int i = 0; i < kSteps; ++i) {
    const Contact c = proxy.step(plane, {x, 0, -kFrictionDepth}, kTick);
    EXPECT_LE(std::abs(c.force.x() / c.force.z()), 0.6 + 1e-9);
    slips += c.sliding && !was_sliding ? 1 : 0;
    was_sliding = c.sliding;
    const double pull = 200 * (speed * kTick * i - x) + (speed - velocity);
    velocity += (pull + c.force.x()) / 0.1 * kTick;
    x += velocity * kTick;
  }
  return slips / (kSteps * kTick);
}

TEST(Friction, SticksAndSlipsWhenSlowAndSlidesWhenFast) {
  const double slow = slips_at(0.005);
  const double faster = slips_at(0.02);
  EXPECT_GE(slow, 0.75);
  EXPECT_LE(slow, 3);
  EXPECT_GT(faster, slow);
  EXPECT_LE(slips_at(0.2), 0.5);
}

TEST(Friction, ViscousForceIsExactlyBTimesSpeed) {
  const PlaneField plane;
  for (const double b : {0.5, 2.0, 5.0, 50.0}) {
    Proxy proxy = pressed(plane, {.viscous = b});
    drive(proxy, plane, {0, 0, -kFrictionDepth}, {0.1, 0, -kFrictionDepth}, 0.1);
    const Contact c =
        drive(proxy, plane, {0.1, 0, -kFrictionDepth}, {0.2, 0, -kFrictionDepth}, 0.1);
    EXPECT_NEAR(-c.force.x(), 0.1 * b, 1e-6 * b) << b;
  }
}

TEST(Friction, ClosedLoopTakesWhatTheoryAsksAndGivesNothing) {
  const PlaneField plane;
  Proxy proxy = pressed(plane, {.static_coefficient = 0.5, .dynamic_coefficient = 0.5});
  const Vector3d center(-0.02, 0, -kFrictionDepth);
  const auto at = [&](int i) {
    const double angle = 2 * M_PI * i / 2000;
    return Vector3d(center + 0.02 * Vector3d(std::cos(angle), std::sin(angle), 0));
  };
  for (int i = 0; i <= 2000; ++i) (void)proxy.step(plane, at(i), kTick);
  double given = 0;
  Vector3d last = proxy.step(plane, at(0), kTick).force;
  for (int i = 1; i <= 2000; ++i) {
    const Vector3d force = proxy.step(plane, at(i), kTick).force;
    given += 0.5 * (force + last).dot(at(i) - at(i - 1));
    last = force;
  }
  // The proxy runs on a smaller circle than the hand: 1.5 mm behind it.
  const double circle = 2 * M_PI * std::sqrt(0.02 * 0.02 - 0.0015 * 0.0015);
  EXPECT_NEAR(given, -0.5 * 500 * kFrictionDepth * circle,
              2e-3 * 0.5 * 500 * kFrictionDepth * circle);
}

TEST(Friction, MaterialFactorScalesIt) {
  PlaneField plane;
  plane.set_surface({.friction_factor = 0.5, .source = 0});
  Proxy proxy = pressed(plane, {.static_coefficient = 0.6, .dynamic_coefficient = 0.6});
  const Contact c = drive(proxy, plane, {0, 0, -kFrictionDepth}, {0.02, 0, -kFrictionDepth}, 0.1);
  EXPECT_NEAR(-c.force.x() / c.force.z(), 0.3, 3e-4);
}

TEST(Friction, NoCoefficientHoldsNothing) {
  const FrictionLaw law = friction_law({}, 1, 500, kTick);
  EXPECT_FALSE(sticks(law, false, 1e-3, 1e-9));
  EXPECT_EQ(held_stretch(law, 1e-3, 2e-3, 0), 0);
}

TEST(Friction, ASlackSpringIsHeldByViscosityAlone) {
  const FrictionLaw law = friction_law({.viscous = 1}, 1, 0, kTick);
  EXPECT_EQ(held_stretch(law, 1e-3, 2e-3, 0), 2e-3);
  EXPECT_EQ(held_stretch(friction_law({}, 1, 0, kTick), 1e-3, 2e-3, 0), 0);
}

}  // namespace
}  // namespace palpate::test
