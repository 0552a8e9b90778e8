// The brake of the passivity controller by itself: a damper that is sampled and delayed.
#include "servo/passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s
constexpr double kSpeed = 0.2;  // m/s, at the start
constexpr double kOwed = 10;    // J: more than there is to be braked, so the brake is at its bound
constexpr int kSteps = 3000;

// A ledger that owes so much that it brakes as hard as it may.
Passivity deeply_in_debt(const GuardOptions::Passivity& options) {
  Passivity ledger(options);
  for (int i = 0; i <= options.delay; ++i) {
    ledger.account(Vector3d::UnitX(), kOwed * Vector3d::UnitX(), 0, kStep);
  }
  for (int i = 0; i <= options.delay; ++i) {
    ledger.account(Vector3d::Zero(), Vector3d::Zero(), 0, kStep);
  }
  return ledger;
}

struct Braked {
  double fastest = 0;  // m/s, from the tenth step on
  double at_end = 0;   // m/s
};

// A device that nobody holds and nothing rubs on, behind a brake that believes in 0.1 kg.
Braked brake_a_free_device(double mass, int delay) {
  SimulatedDevice device({.mass = mass,
                          .damping = 0,
                          .coulomb = 0,
                          .resolution = 0,
                          .delay = delay,
                          .hand = {.stiffness = 0, .damping = 0},
                          .velocity = {kSpeed, 0, 0}});
  Passivity ledger = deeply_in_debt({.mass = 0.1, .delay = delay});
  Braked result;
  Vector3d before = device.read().position;
  device.write(Vector3d::Zero());
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d place = device.read().position;
    device.write(ledger.brake(Vector3d::Zero(), place - before, kStep));
    before = place;
    result.at_end = device.true_velocity().norm();
    if (i >= 10 + delay) result.fastest = std::max(result.fastest, result.at_end);
  }
  return result;
}

TEST(Passivity, BrakeAtItsBoundShakesNoDeviceHalfAsHeavyAsItBelieves) {
  for (const int delay : {0, 1, 2, 3, 5, 8, 16}) {
    for (const double mass : {0.045, 0.1, 1.0}) {
      const Braked braked = brake_a_free_device(mass, delay);
      EXPECT_LT(braked.fastest, kSpeed) << mass << " kg, delay " << delay;
      EXPECT_LT(braked.at_end, 0.02 * kSpeed) << mass << " kg, delay " << delay;
    }
  }
}

}  // namespace
}  // namespace palpate
