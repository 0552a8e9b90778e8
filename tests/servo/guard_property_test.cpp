// What the guard promises whatever it is told.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "palpate/servo/guard.hpp"
#include "servo/allowed_step.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// Numbers as they come, and now and then as they should never come.
double number(double scale, bool wild) {
  const double plain = scale * 1e-3 * *rc::gen::inRange(-1000, 1001);
  if (!wild) return plain;
  const double infinity = std::numeric_limits<double>::infinity();
  return *rc::gen::weightedElement<double>({{40, plain},
                                            {1, std::numeric_limits<double>::quiet_NaN()},
                                            {1, infinity},
                                            {1, -infinity},
                                            {1, 1e308},
                                            {1, 1e-310},
                                            {1, 0.0}});
}

Vector3d vector(double scale, bool wild) {
  return {number(scale, wild), number(scale, wild), number(scale, wild)};
}

// A step of a hand that moves at up to 1 m/s or rests, in contact or not, at any force up to 50 N.
Guard::Input input(bool wild, const Vector3d& before) {
  Guard::Input made;
  made.force = *rc::gen::element(0.0, 1.0, 1.0) * vector(50, wild);
  made.hip = before + *rc::gen::element(0.0, 1.0) * vector(1e-3, wild);
  made.velocity = vector(1, wild);
  made.dt = *rc::gen::weightedElement<double>({{30, 1e-3}, {3, 2e-3}, {2, 0.0}, {1, 0.2}});
  if (wild) made.dt = *rc::gen::weightedElement<double>({{60, made.dt}, {1, -1.0}});
  made.stiffness = *rc::gen::element(0.0, 100.0, 500.0, 2000.0);
  if (wild) made.stiffness = *rc::gen::element(0.0, 500.0, 1e-310, 1e-300, 1e308);
  made.normal = *rc::gen::element(Vector3d(0, 0, 0), Vector3d(0, 0, 1), Vector3d(0.6, 0, -0.8));
  made.drift = *rc::gen::element(0.0, 0.0, 0.1) * vector(1, wild);
  made.felt = *rc::gen::weightedElement<bool>({{20, true}, {1, false}});
  return made;
}

std::vector<Guard::Input> inputs(bool wild) {
  std::vector<Guard::Input> all;
  const int count = *rc::gen::inRange(1, 60);
  Vector3d hip = Vector3d::Zero();
  for (int i = 0; i < count; ++i) {
    all.push_back(input(wild, hip));
    if (all.back().hip.allFinite()) hip = all.back().hip;
  }
  return all;
}

RC_GTEST_PROP(GuardProperty, NeverLetsPassWhatIsNotFiniteOrTooLong, ()) {
  const GuardOptions options{.maximum_force = *rc::gen::element(0.5, 3.0, 16.0)};
  Guard guard(options);
  for (const Guard::Input& each : inputs(true)) {
    const bool faulted = guard.state().fault != Guard::Fault::none;
    const Vector3d force = guard.pass(each);
    RC_ASSERT(force.allFinite());
    RC_ASSERT(force.norm() <= options.maximum_force * (1 + 1e-12));
    if (faulted) RC_ASSERT(force.isZero(0));
    if (has(guard.state().notes, GuardNote::fault)) RC_ASSERT(force.isZero(0));
    if (!each.force.allFinite()) RC_ASSERT(guard.state().fault != Guard::Fault::none);
  }
}

RC_GTEST_PROP(GuardProperty, NeverStepsFurtherThanHandAndSlewAllow, ()) {
  GuardOptions options;
  options.maximum_force = *rc::gen::element(0.5, 3.0, 16.0);
  options.damping = *rc::gen::element(0.0, 1.0);
  options.passivity.on = *rc::gen::arbitrary<bool>();
  options.soft_start = *rc::gen::element(0.0, 0.01);
  Guard guard(options);
  test::AllowedStep allowed_step(options);
  Vector3d before = Vector3d::Zero();
  for (const Guard::Input& each : inputs(false)) {
    const Vector3d force = guard.pass(each);
    const double allowed = allowed_step(each, guard.state().notes);
    if (each.dt > options.silence) {
      RC_ASSERT(force.isZero(0));
    } else {
      RC_ASSERT((force - before).norm() <= allowed + 1e-12);
    }
    before = force;
  }
}

// Without the damper, which always acts, no link changes a force and does not say so.
RC_GTEST_PROP(GuardProperty, ChangesNothingThatNeedsNoChange, ()) {
  Guard guard({.maximum_force = 16, .damping = 0, .soft_start = 0});
  for (const Guard::Input& each : inputs(false)) {
    const Vector3d force = guard.pass(each);
    if (guard.state().notes == GuardNote::none && each.felt) RC_ASSERT(force == each.force);
  }
}

}  // namespace
}  // namespace palpate
