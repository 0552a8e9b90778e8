#include "palpate/servo/guard.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "palpate/base/error.hpp"
#include "servo/guard_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::plain;
using test::pushed;

constexpr double kDt = 1e-3;  // s
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Pressing into a floor at z = 0 along z, as a proxy would answer.
Guard::Input pressed(double z) {
  return pushed({0, 0, z < 0 ? -500 * z : 0}, {0, 0, z});
}

TEST(Guard, LetsASpringPassBitForBitThatTheHandStretches) {
  Guard guard(plain(16));
  for (int i = 0; i < 2000; ++i) {
    // 0.2 m/s at most, to 13 mm: comes in, goes out.
    const double z = 3e-3 - 16e-3 * std::abs(std::sin(0.0125 * i));
    const Guard::Input input = pressed(z);
    ASSERT_EQ(guard.pass(input), input.force) << "step " << i;
    ASSERT_EQ(guard.state().notes, GuardNote::none);
  }
  EXPECT_EQ(guard.state().counts.steps, 2000u);
  EXPECT_EQ(in_words(guard.state()), "");
}

TEST(Guard, LetsAHandGoAtOnceThatLeavesFast) {
  Guard guard(plain());
  for (int i = 0; i < 100; ++i) static_cast<void>(guard.pass(pressed(-1e-4 * i)));
  Guard::Input out = pressed(5e-3);  // 15 mm in a step
  out.stiffness = 0;                 // it touches nothing now
  EXPECT_EQ(guard.pass(out), Vector3d::Zero());
  EXPECT_EQ(guard.state().notes, GuardNote::none);
}

TEST(Guard, SlewsWhatTheHandDidNotDo) {
  Guard guard(plain());
  static_cast<void>(guard.pass(pushed({0, 0, 0})));
  const double step = 300 * kDt;
  for (int i = 1; i <= 20; ++i) {
    const Vector3d force = guard.pass(pushed({0, 3, 4}));
    const double expected = std::min(i * step, 5.0);
    EXPECT_NEAR(force.norm(), expected, 1e-12);
    EXPECT_NEAR(force.cross(Vector3d(0, 3, 4)).norm(), 0, 1e-12) << "straight to the new force";
    EXPECT_EQ(has(guard.state().notes, GuardNote::slewed), i * step < 5.0);
  }
  EXPECT_EQ(guard.state().counts.slewed, 16u);
}

TEST(Guard, ShortensToTheMaximumAndKeepsTheDirection) {
  Guard guard(plain(3));
  Vector3d force;
  for (int i = 0; i <= 100; ++i) {
    const Vector3d hip = Vector3d(-1e-4, -2e-4, -2e-4) * i;
    force = guard.pass(pushed(-500 * hip, hip));
    ASSERT_LE(force.norm(), 3 * (1 + 1e-15));
    ASSERT_EQ(has(guard.state().notes, GuardNote::clamped), i > 20) << i;
  }
  EXPECT_TRUE(force.isApprox(Vector3d(1, 2, 2), 1e-12));
  EXPECT_EQ(guard.state().counts.clamped, 80u);
}

TEST(Guard, HoldsZeroAtOnceAndUntilResetWhenSomethingIsNotFinite) {
  const std::vector<std::pair<Guard::Fault, Guard::Input>> cases = [] {
    std::vector<std::pair<Guard::Fault, Guard::Input>> all;
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
      all.emplace_back(Guard::Fault::force, pushed({0, bad, 2}));
      all.emplace_back(Guard::Fault::hand, pushed({0, 0, 2}, {bad, 0, 0}));
      all.emplace_back(Guard::Fault::hand, pushed({0, 0, 2}));
      all.back().second.velocity.z() = bad;
      all.emplace_back(Guard::Fault::force, pushed({0, 0, 2}));
      all.back().second.stiffness = bad;
    }
    for (const double bad : {kNaN, kInfinity, -1e-9}) {
      all.emplace_back(Guard::Fault::time, pushed({0, 0, 2}));
      all.back().second.dt = bad;
    }
    for (const Guard::Fault known : {Guard::Fault::proxy, Guard::Fault::device}) {
      all.emplace_back(known, pushed({0, 0, 2}));
      all.back().second.fault = known;
    }
    return all;
  }();
  for (const auto& [fault, input] : cases) {
    Guard guard(plain());
    for (int i = 0; i < 50; ++i) static_cast<void>(guard.pass(pushed({0, 0, 2})));
    ASSERT_EQ(guard.pass(pushed({0, 0, 2})), Vector3d(0, 0, 2));
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(guard.pass(i == 0 ? input : pushed({0, 0, 2})), Vector3d::Zero());
      ASSERT_EQ(guard.state().fault, fault);
      ASSERT_TRUE(has(guard.state().notes, GuardNote::fault));
    }
    EXPECT_EQ(guard.state().counts.faults, 1u);
    EXPECT_NE(in_words(guard.state()).find(in_words(fault)), std::string::npos);
    guard.reset();
    EXPECT_NEAR(guard.pass(pushed({0, 0, 2})).norm(), 0.3, 1e-12) << "up from zero";
    EXPECT_EQ(guard.state().fault, Guard::Fault::none);
  }
}

TEST(Guard, LetsAForceFadeWhenItIsReset) {
  GuardOptions options = plain();
  options.soft_start = 0.5;
  Guard guard(options);
  const Guard::Input resting = pushed({0, 0, 10});
  double before = 0;
  for (int i = 0; i < 1000; ++i) before = guard.pass(resting).z();
  ASSERT_EQ(before, 10);
  guard.reset();
  for (int i = 0; before > 0; ++i) {
    ASSERT_LT(i, 40) << "it stays";
    const double force = guard.pass(resting).z();
    EXPECT_NEAR(before - force, std::min(before, 0.3), 1e-9);
    before = force;
  }
  EXPECT_EQ(guard.pass(resting).norm(), 10 * 1e-3 / 0.5) << "it comes up softly";
}

TEST(Guard, GivesZeroAfterASilenceAndComesBackSoftly) {
  Guard guard(plain());
  for (int i = 0; i < 50; ++i) static_cast<void>(guard.pass(pushed({0, 0, 2})));
  Guard::Input late = pushed({0, 0, 2}, {0, 0, -0.05});  // wherever the hand went meanwhile
  late.dt = 0.1;
  EXPECT_EQ(guard.pass(late), Vector3d::Zero());
  EXPECT_TRUE(has(guard.state().notes, GuardNote::silence));
  EXPECT_NE(in_words(guard.state()).find("watchdog"), std::string::npos);
  for (int i = 1; i <= 6; ++i) {
    EXPECT_NEAR(guard.pass(pushed({0, 0, 2}, {0, 0, -0.05})).z(), 0.3 * i, 1e-12);
  }
  EXPECT_EQ(guard.state().counts.silences, 1u);
}

// A step that came 21 ms late once changed the force of a page's tool by 7.57 N, of which the slew
// of 300 N/s in its time is 6.3 N and the rest the hand's own way. A device gets nothing then.
TEST(Guard, AStepThatIsLateGivesADeviceNothingAndAPageTheSlewOfItsTime) {
  for (const double silence : {GuardOptions().silence, kInfinity}) {
    GuardOptions options = plain();
    options.silence = silence;
    Guard guard(options);
    static_cast<void>(guard.pass(pushed(Vector3d::Zero())));
    Guard::Input late = pushed({0, 0, 50}, {0, 0, -2e-3});
    late.dt = 0.021;
    const double given = guard.pass(late).z();
    const double most = std::isinf(silence) ? options.slew * late.dt + 500 * 2e-3 : 0;
    EXPECT_DOUBLE_EQ(given, most);
  }
}

TEST(Guard, HasPatienceUpToTheSilenceItWasTold) {
  GuardOptions options = plain();
  options.silence = 0.05;
  Guard guard(options);
  Guard::Input slow = pushed({0, 0, 1});
  slow.dt = 0.04;
  static_cast<void>(guard.pass(slow));
  EXPECT_EQ(guard.pass(slow), slow.force);
  EXPECT_EQ(guard.state().counts.silences, 0u);
}

TEST(Guard, ComesUpSoftlyWhenItStartsInContact) {
  Guard guard(plain());
  EXPECT_NEAR(guard.pass(pushed({0, 0, 5})).z(), 0.3, 1e-12);
  EXPECT_NEAR(guard.pass(pushed({0, 0, 5})).z(), 0.6, 1e-12);
}

TEST(Guard, ThatIsOffLetsEveryForcePass) {
  Guard guard({.on = false});
  EXPECT_EQ(guard.pass(pushed({0, 0, 1e6})), Vector3d(0, 0, 1e6));
  Guard::Input input = pushed({0, 0, 5});
  input.felt = false;
  EXPECT_EQ(guard.pass(input), Vector3d::Zero());
  EXPECT_EQ(guard.state().counts.steps, 2u);
  EXPECT_EQ(guard.pass(pushed({0, 0, std::nan("")})), Vector3d::Zero()) << "but what is no force";
  EXPECT_EQ(guard.state().fault, Guard::Fault::force);
}

TEST(Guard, RefusesOptionsOutOfRange) {
  for (const double bad : {0.0, -1.0, kNaN}) {
    EXPECT_THROW(Guard({.maximum_force = bad}), Error);
    EXPECT_THROW(Guard({.slew = bad}), Error);
    EXPECT_THROW(Guard({.silence = bad}), Error);
  }
  EXPECT_THROW(Guard({.slew = kInfinity}), Error);
  EXPECT_THROW(Guard({.damping = -0.1}), Error);
  EXPECT_THROW(Guard({.soft_start = -0.1}), Error);
  EXPECT_THROW(Guard({.stiffness_share = 0}), Error);
  EXPECT_THROW(Guard({.passivity = {.mass = 0}}), Error);
  EXPECT_THROW(Guard({.passivity = {.memory = -1}}), Error);
  EXPECT_THROW(Guard({.passivity = {.forget = 0}}), Error);
  EXPECT_THROW(Guard({.passivity = {.delay = 17}}), Error);
  EXPECT_NO_THROW(Guard({.silence = kInfinity}));
}

TEST(Guard, AForceThatStaysAtItsBoundIsNotCalledSlow) {
  GuardOptions options = plain();
  options.maximum_force = 1;
  Guard guard(options);
  Vector3d force;
  for (int i = 0; i < 50; ++i) force = guard.pass(pushed({0, 0, 5}));
  EXPECT_EQ(force.z(), 1);
  EXPECT_EQ(guard.state().notes, GuardNote::clamped);
  EXPECT_EQ(guard.state().counts.clamped, 50u) << "once a step";
}

}  // namespace
}  // namespace palpate
