// What the guard's links are for: walls on simulated devices against theory and against themselves
// without a link (docs/method.md 8).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "servo/oscillation.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

GuardOptions without_links() {
  GuardOptions guard;
  guard.damping = 0;
  guard.soft_start = 0;
  guard.passivity.on = false;
  return guard;
}

WallOptions free_wall(double damping, int delay) {
  WallOptions wall;
  wall.guard = without_links();
  wall.device.damping = damping;
  wall.device.coulomb = 0;
  wall.device.delay = delay;
  return wall;
}

TEST(Stability, LimitIsColgatesWithAndWithoutDelay) {
  for (const int delay : {0, 1}) {
    for (const double damping : {0.2, 0.5, 1.0, 2.0}) {
      const WallOptions wall = free_wall(damping, delay);
      const double theory = passive_stiffness(damping, 1e-3, 1e-3 * delay);
      EXPECT_NEAR(stable_stiffness(wall), theory, 0.1 * theory) << damping << ", delay " << delay;
      EXPECT_NEAR(rebound_stiffness(wall), theory, 0.1 * theory) << damping << ", delay " << delay;
    }
  }
}

TEST(Stability, DamperOfTheWallRaisesTheLimit) {
  WallOptions wall = free_wall(0.5, 1);
  const double bare = stable_stiffness(wall);
  wall.guard.damping = 1;
  EXPECT_GT(stable_stiffness(wall), 2 * bare);
}

// 12.5 mJ come in. What the last force gives, on its way while the device leaves, no link takes
// back.
TEST(Stability, ImpactReturnsNoEnergyWithTheDamper) {
  WallOptions wall;
  wall.stiffness = 500;
  wall.speed = 0.5;
  wall.guard = without_links();
  const Impact bare = impact(wall);
  EXPECT_GT(bare.rebound, 1);
  EXPECT_GT(bare.energy, 1e-3);
  wall.guard.damping = 1;
  const Impact damped = impact(wall);
  EXPECT_LT(damped.rebound, 0.9);
  EXPECT_LE(damped.energy, 0.1e-3);
  wall.guard.passivity.on = true;
  EXPECT_LE(impact(wall).energy, 0.02e-3);
  wall.guard = without_links();
  wall.guard.passivity.on = true;
  EXPECT_LE(impact(wall).energy, 0.1 * bare.energy);
}

// What became of somebody's leaning on a wall with `press` (N) for three seconds.
struct Leaning {
  double swing = 0;   // of the device in the last half second, m, peak to peak
  double energy = 0;  // that the wall gave, J
};

Leaning lean(const WallOptions& options, double press) {
  SimulatedDeviceOptions made = options.device;
  made.hand = {.stiffness = 1, .damping = 0, .maximum_force = press};
  const Vector3d aim(0, 0, -press / made.hand.stiffness);
  SimulatedDevice device(made, {{0, {0, 0, 1e-3}}, {1e-3, aim}, {3, aim}});
  Guard guard(options.guard);
  Leaning result;
  double low = 1;
  double high = -1;
  for (std::size_t i = 0; i < 3000; ++i) {
    const DeviceState hand = device.read();
    Guard::Input input;
    input.hip = hand.position;
    input.velocity = hand.velocity;
    input.dt = 1e-3;
    if (hand.position.z() < 0) {
      input.force.z() = -options.stiffness * hand.position.z();
      input.normal.z() = 1;
      input.stiffness = options.stiffness;
    }
    const double z = device.true_position().z();
    device.write(guard.pass(input));
    if (i < 2500) continue;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  result.swing = high - low;
  result.energy = device.work();
  return result;
}

// Twice as stiff as the device with the damper could bear.
WallOptions too_stiff(double coulomb) {
  WallOptions wall;
  wall.device.coulomb = coulomb;
  wall.guard.soft_start = 0;
  wall.stiffness = 2 * passive_stiffness(wall.device.damping + wall.guard.damping, 1e-3, 1e-3);
  return wall;
}

TEST(Stability, BrakeEndsLimitCyclesAtTwiceThePassiveStiffness) {
  for (const double coulomb : {0.0, 0.05}) {
    for (const double press : {0.5, 1.0, 2.0}) {
      WallOptions wall = too_stiff(coulomb);
      EXPECT_LT(lean(wall, press).swing, 0.3e-3) << press << " N, friction " << coulomb;
      wall.guard.passivity.on = false;
      EXPECT_GT(lean(wall, press).swing, 3e-3) << press << " N, friction " << coulomb;
    }
  }
}

TEST(Stability, NoWallGivesAHandThatLeansOnItAMillijoule) {
  for (const double coulomb : {0.0, 0.05}) {
    for (const double damping : {0.0, 1.0}) {
      for (const double share : {0.25, 0.5, 1.0, 2.0}) {
        for (const double press : {0.5, 1.0, 2.0, 4.0}) {
          WallOptions wall = too_stiff(coulomb);
          wall.guard.damping = damping;
          wall.stiffness = share * passive_stiffness(0.5 + damping, 1e-3, 1e-3);
          EXPECT_LT(lean(wall, press).energy, 1e-3)
              << wall.stiffness << " N/m, " << press << " N, friction " << coulomb;
        }
      }
    }
  }
}

// A device that nobody holds, let go beside a proxy that sticks to a surface.
struct Stuck {
  double mass = 0.1;       // kg; the guard believes in 0.1
  double damping = 0.5;    // of the device, N s/m
  int delay = 3;           // as behind a driver's thread
  double distance = 5e-3;  // m
};

// How far it swings in the end, on a spring as stiff as is felt.
double swing_beside_a_stuck_proxy(const Stuck& stuck, GuardOptions options) {
  SimulatedDevice device({.mass = stuck.mass,
                          .damping = stuck.damping,
                          .coulomb = 0,
                          .resolution = 0,
                          .delay = stuck.delay,
                          .hand = {.stiffness = 0, .damping = 0},
                          .position = {stuck.distance, 0, 0}});
  options.soft_start = 0;
  options.passivity.delay = stuck.delay;
  Guard guard(options);
  Guard::Input input;
  input.normal.z() = 1;
  input.dt = 1e-3;
  input.stiffness = 0.8 * passive_stiffness(stuck.damping + 1, 1e-3, 1e-3 * stuck.delay);
  double swing = 0;
  for (int i = 0; i < 3500; ++i) {
    const DeviceState hand = device.read();
    input.hip = hand.position;
    input.velocity = hand.velocity;
    input.force = -input.stiffness * hand.position;
    device.write(guard.pass(input));
    if (i >= 3300) swing = std::max(swing, device.true_position().norm());
  }
  return swing;
}

TEST(Stability, DamperActsAlongASurfaceWhereTheProxySticks) {
  const GuardOptions bare{.damping = 0, .passivity = {.on = false}};
  const GuardOptions damped{.damping = 1, .passivity = {.on = false}};
  EXPECT_GT(swing_beside_a_stuck_proxy({}, bare), 5e-3);
  EXPECT_LT(swing_beside_a_stuck_proxy({}, damped), 0.5e-3);
}

TEST(Stability, BrakeAndDamperTogetherShakeNoLightDevice) {
  for (const int delay : {0, 1, 3, 8, 12, 16}) {
    for (const double damping : {0.1, 0.5}) {
      const Stuck stuck{.mass = 0.045, .damping = damping, .delay = delay, .distance = 20e-3};
      EXPECT_LT(swing_beside_a_stuck_proxy(stuck, {}), 1e-3) << damping << ", delay " << delay;
    }
  }
}

TEST(Stability, HandThatRestsOnAWallIsGivenNothingByASoftStart) {
  WallOptions wall = too_stiff(0.05);
  wall.stiffness = 500;
  wall.guard.soft_start = 0.5;
  EXPECT_LT(lean(wall, 2).energy, 1e-4) << "from the first step on it falls into the wall";
}

}  // namespace
}  // namespace palpate
