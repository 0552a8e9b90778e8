// The links of the guard that know of contact: damper, soft start, passivity, stiffness.
#include <gtest/gtest.h>

#include <algorithm>

#include "servo/guard_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::plain;
using test::pushed;

Guard::Input touching(const Vector3d& force, const Vector3d& velocity) {
  Guard::Input input = pushed(force);
  input.normal = Vector3d::UnitZ();
  input.velocity = velocity;
  return input;
}

TEST(Guard, DampsAlongTheNormalOfWhatIsTouched) {
  GuardOptions options = plain();
  options.damping = 1;
  Guard guard(options);
  const Vector3d velocity(0.3, 0, -0.4);
  Vector3d force;
  for (int i = 0; i < 100; ++i) force = guard.pass(touching({0.2, 0, 2}, velocity));
  EXPECT_TRUE(force.isApprox(Vector3d(0.2, 0, 2.4), 1e-9)) << force.transpose();
  for (int i = 0; i < 100; ++i) force = guard.pass(touching({0.2, 0, 0.1}, -velocity));
  EXPECT_NEAR(force.z(), 0, 1e-9) << "it attracts";
  EXPECT_NEAR(force.x(), 0.2, 1e-9);
  Guard::Input carried = touching({0, 0, 2}, velocity);
  carried.drift = velocity;  // the surface moves along with the hand
  for (int i = 0; i < 100; ++i) force = guard.pass(carried);
  EXPECT_NEAR(force.z(), 2, 1e-9);
  Guard::Input free = touching({0, 0, 0}, velocity);
  free.normal.setZero();
  for (int i = 0; i < 100; ++i) force = guard.pass(free);
  EXPECT_EQ(force, Vector3d::Zero()) << "drags in the air";
}

// What a damper of 1 N s/m adds to a spring's force on a hand at 0.2 m/s along a surface that it
// presses 4 mm deep, when the proxy goes along in a share of its way.
double drag(double share) {
  GuardOptions options = plain();
  options.damping = 1;
  Guard guard(options);
  Guard::Input input = touching({0, 0, 2}, {0.2, 0, 0});
  double drag = 0;
  for (int i = 0; i < 100; ++i) {
    input.hip.x() = 2e-4 * i;
    input.force.x() = input.stiffness * (share * input.hip.x() - input.hip.x());
    drag = guard.pass(input).x() - input.force.x();
  }
  return drag;
}

TEST(Guard, DampsAlongTheSurfaceWhatTheProxyDoesNotFollow) {
  EXPECT_NEAR(drag(1), 0, 1e-9) << "it slides";
  EXPECT_NEAR(drag(1.2), 0, 1e-9) << "ahead, on the inside of a bend";
  EXPECT_NEAR(drag(0.5), -0.1, 1e-9);
  EXPECT_NEAR(drag(0), -0.2, 1e-9) << "it sticks";
  EXPECT_NEAR(drag(-1), -0.2, 1e-9) << "no more than all";
}

TEST(Guard, AllowsWhatTheDamperMakesOfAChangeOfVelocity) {
  GuardOptions options = plain();
  options.damping = 1;
  options.slew = 1e-3;
  Guard guard(options);
  static_cast<void>(guard.pass(touching({0, 0, 0}, {0, 0, 0})));
  EXPECT_NEAR(guard.pass(touching({0, 0, 0}, {0, 0, -0.4})).z(), 0.1, 1e-12) << "a quarter of it";
  EXPECT_EQ(guard.state().notes, GuardNote::none);
}

TEST(Guard, ComesUpSoftlyWhileNothingIsTouched) {
  GuardOptions options = plain();
  options.soft_start = 0.1;
  Guard guard(options);
  const Guard::Input free = pushed({0, 0, 0});
  for (int i = 0; i < 50; ++i) static_cast<void>(guard.pass(free));
  // Half way up; in contact it stays, for the hand has paid nothing.
  Vector3d force;
  for (int i = 0; i < 200; ++i) force = guard.pass(touching({0, 0, 2}, {0, 0, 0}));
  EXPECT_NEAR(force.z(), 1, 1e-9);
  EXPECT_TRUE(has(guard.state().notes, GuardNote::starting));
  EXPECT_NE(in_words(guard.state()).find("ramps up"), std::string::npos);
  for (int i = 0; i < 50; ++i) static_cast<void>(guard.pass(free));
  for (int i = 0; i < 20; ++i) force = guard.pass(touching({0, 0, 2}, {0, 0, 0}));
  EXPECT_EQ(force.z(), 2) << "lifted and touched again";
  EXPECT_FALSE(has(guard.state().notes, GuardNote::starting));
}

TEST(Guard, StartsSoftlyAgainAfterWhatWasNotFelt) {
  GuardOptions options = plain();
  options.soft_start = 0.1;
  Guard guard(options);
  for (int i = 0; i < 200; ++i) static_cast<void>(guard.pass(pushed({0, 0, 0})));
  for (int i = 0; i < 20; ++i) static_cast<void>(guard.pass(touching({0, 0, 2}, {0, 0, 0})));
  Guard::Input unfelt = touching({0, 0, 2}, {0, 0, 0});
  unfelt.felt = false;
  EXPECT_NEAR(guard.pass(unfelt).z(), 1.7, 1e-9) << "goes at the rate of the slew";
  for (int i = 0; i < 20; ++i) static_cast<void>(guard.pass(unfelt));
  EXPECT_EQ(guard.pass(unfelt), Vector3d::Zero());
  EXPECT_LT(guard.pass(touching({0, 0, 2}, {0, 0, 0})).z(), 0.03);
}

TEST(Guard, BrakesAHandThatWasGivenEnergy) {
  GuardOptions options = plain();
  options.passivity = {.on = true, .delay = 0};
  options.slew = 1e6;
  Guard guard(options);
  double given = 0;
  Vector3d hip = Vector3d::Zero();
  Vector3d force = Vector3d::Zero();
  bool braked = false;
  for (int i = 0; i < 100; ++i) {  // thrown out by 1 N that nobody put in
    const Vector3d next = hip + Vector3d(0, 0, 1e-4);
    given += force.dot(next - hip);
    hip = next;
    Guard::Input input = touching({0, 0, 1}, {0, 0, 0.1});
    input.hip = hip;
    force = guard.pass(input);
    braked = braked || has(guard.state().notes, GuardNote::braked);
  }
  EXPECT_TRUE(braked);
  EXPECT_LT(given, 0.2e-3) << "of 10 mJ";
  EXPECT_NEAR(guard.state().energy, given, 1e-12);
  EXPECT_NE(in_words(guard.state()).find("braking"), std::string::npos);
}

TEST(Guard, WorkOfAMovingSurfaceIsItsOwn) {
  GuardOptions options = plain();
  options.passivity.on = true;
  Guard guard(options);
  for (int i = 0; i < 1000; ++i) {  // carries the hand along with 1 N
    Guard::Input input = touching({0, 0, 1}, {0, 0, 0.1});
    input.hip = Vector3d(0, 0, 1e-4 * i);
    input.drift = input.velocity;
    ASSERT_NEAR(guard.pass(input).z(), std::min(0.3 + 0.35 * i, 1.0), 1e-9) << "step " << i;
  }
  EXPECT_NEAR(guard.state().energy, 0, 1e-9);
}

// Pressed 16 mm deep at a walking pace; then the surface is gone, and the hand flies out at 1 m/s.
double given_by_fading(bool passivity) {
  GuardOptions options = plain();
  options.passivity = {.on = passivity, .delay = 0};
  Guard guard(options);
  Guard::Input input = touching({0, 0, 0}, {0, 0, -0.1});
  Vector3d force = Vector3d::Zero();
  double given = 0;
  const auto go = [&](double way) {
    given += force.z() * way;
    input.hip.z() += way;
    force = guard.pass(input);
  };
  for (int i = 1; i <= 160; ++i) {
    input.force.z() = 500e-4 * i;
    go(-1e-4);
  }
  EXPECT_NEAR(given, -64e-3, 1e-3);
  input = pushed({0, 0, 0}, input.hip);
  input.stiffness = 0;
  input.velocity.z() = 1;
  for (int i = 0; i < 100; ++i) go(1e-3);
  EXPECT_EQ(force, Vector3d::Zero());
  return given;
}

TEST(Guard, AForceThatFadesGivesNoMoreThanWasPaidFor) {
  EXPECT_GT(given_by_fading(false), 30e-3) << "what the slew alone does";
  EXPECT_LT(given_by_fading(true), 5e-3);
}

TEST(Guard, NoContactPaysForTheNext) {
  GuardOptions options = plain();
  options.passivity = {.on = true, .delay = 0};
  Guard guard(options);
  for (int i = 0; i < 100; ++i) {  // dragged through 1 N: 10 mJ, of which nothing is stored
    Guard::Input input = touching({-1, 0, 0}, {0.1, 0, 0});
    input.hip = Vector3d(1e-4 * i, 0, 0);
    input.stiffness = 1e6;
    static_cast<void>(guard.pass(input));
  }
  EXPECT_LT(guard.state().energy, -5e-3);
  for (int i = 0; i < 10; ++i) static_cast<void>(guard.pass(pushed({0, 0, 0}, {0.01, 0, 0})));
  EXPECT_EQ(guard.state().energy, 0);
}

TEST(Guard, SaysWhatIsSofterThanAskedFor) {
  Guard guard(plain());
  Guard::Input input = touching({0, 0, 0.1}, {0, 0, 0});
  input.softened = true;
  EXPECT_EQ(guard.pass(input), input.force);
  EXPECT_TRUE(has(guard.state().notes, GuardNote::softened));
  EXPECT_EQ(guard.state().counts.softened, 1u);
  EXPECT_NE(in_words(guard.state()).find("softer"), std::string::npos);
}

TEST(Guard, OptionsAtTheHandBecomeThoseOfAMagnifiedWorld) {
  const GuardOptions world =
      in_world({.damping = 1, .passivity = {.mass = 0.1, .memory = 0.02}}, 10);
  EXPECT_DOUBLE_EQ(world.damping, 0.1);
  EXPECT_DOUBLE_EQ(world.passivity.mass, 0.01);
  EXPECT_DOUBLE_EQ(world.passivity.memory, 0.2);
}

}  // namespace
}  // namespace palpate
