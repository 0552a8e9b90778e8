// The wrist of a simulated device: Euler's equation, friction, encoders, motors and the hand.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/turn.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// A wrist that nobody holds and nothing rubs on.
SimulatedDeviceOptions loose() {
  SimulatedDeviceOptions options;
  options.wrist.emplace();
  options.wrist->inertia = {9e-5, 5e-5, 2e-5};
  options.wrist->damping = 0;
  options.wrist->coulomb = 0;
  options.wrist->resolution = 0;
  options.wrist->hand = {.stiffness = 0, .damping = 0, .maximum_torque = 1};
  options.wrist->maximum_torque = 0.5;
  return options;
}

double angle_of(const SimulatedDevice& device) {
  return turn_between(Quaterniond::Identity(), device.true_orientation()).norm();
}

// What spins freely keeps its angular momentum in the device's axes, and its energy.
TEST(HeldWrist, KeepsItsMomentumWhileItTumbles) {
  SimulatedDeviceOptions options = loose();
  options.wrist->velocity = {1, 4, 0.5};
  SimulatedDevice device(options);
  const Vector3d momentum = options.wrist->inertia.cwiseProduct(options.wrist->velocity);
  DeviceState state = device.read();
  for (int i = 0; i < 2000; ++i) {
    const Quaterniond before = state.orientation;
    state = device.read();
    const Quaterniond middle = turned(before, 0.5e-3 * state.angular_velocity);
    const Vector3d rate = middle.conjugate() * state.angular_velocity;
    const Vector3d now = middle * options.wrist->inertia.cwiseProduct(rate).eval();
    // The rule is of first order: parts of 1/16 ms err by their number times their square.
    ASSERT_NEAR((now - momentum).norm() / momentum.norm(), 0, 2e-3) << i;
  }
  EXPECT_NEAR(state.orientation.norm(), 1, 1e-12);
}

TEST(HeldWrist, TurnsByAHeldTorqueAsFarAsItsInertiaSays) {
  SimulatedDevice device(loose());
  (void)device.read();
  for (int i = 0; i < 100; ++i) {
    device.write_wrench({.torque = {0, 2e-3, 0}});
    (void)device.read();
  }
  // One step of delay: 99 ms. The rule is late by half a part.
  EXPECT_NEAR(angle_of(device), 0.5 * 2e-3 / 5e-5 * 0.099 * 0.099, 3e-4);
  EXPECT_NEAR(device.work(), 2e-3 * angle_of(device), 1e-12);
}

TEST(HeldWrist, HasNoMotorsUnlessItIsGivenThem) {
  SimulatedDeviceOptions options = loose();
  options.wrist->maximum_torque = 0;
  SimulatedDevice device(options);
  EXPECT_EQ(device.info().maximum_torque, 0);
  EXPECT_TRUE(device.info().has_orientation);
  (void)device.read();
  for (int i = 0; i < 100; ++i) {
    device.write_wrench({.torque = {0, 2e-3, 0}});
    (void)device.read();
  }
  EXPECT_EQ(angle_of(device), 0);
}

TEST(HeldWrist, ShortensATorqueToItsMotors) {
  SimulatedDeviceOptions options = loose();
  options.wrist->maximum_torque = 2e-3;
  SimulatedDevice device(options);
  (void)device.read();
  for (int i = 0; i < 100; ++i) {
    device.write_wrench({.torque = {0, 7, 0}});
    (void)device.read();
  }
  EXPECT_NEAR(angle_of(device), 0.5 * 2e-3 / 5e-5 * 0.099 * 0.099, 3e-4);
}

// A force alone lets the torque go.
TEST(HeldWrist, LosesItsTorqueWithAForceAlone) {
  SimulatedDeviceOptions options = loose();
  options.delay = 0;
  SimulatedDevice device(options);
  (void)device.read();
  device.write_wrench({.torque = {0, 2e-3, 0}});
  DeviceState first = device.read();
  first = device.read();
  device.write(Vector3d::Zero());
  const double rate = device.read().angular_velocity.y();
  EXPECT_NEAR(device.read().angular_velocity.y(), rate, 1e-9);
  EXPECT_GT(rate, first.angular_velocity.y());
}

TEST(HeldWrist, IsHeldByDryFriction) {
  SimulatedDeviceOptions options = loose();
  options.wrist->coulomb = 1e-3;
  for (const double torque : {0.99e-3, 1.01e-3}) {
    SimulatedDevice device(options);
    (void)device.read();
    for (int i = 0; i < 1000; ++i) {
      device.write_wrench({.torque = {0, torque, 0}});
      (void)device.read();
    }
    EXPECT_EQ(angle_of(device) > 0, torque > 1e-3);
  }
}

TEST(HeldWrist, FollowsTheHandAndYieldsWhereItIsHeldBack) {
  SimulatedDeviceOptions options = loose();
  options.wrist->hand = {.stiffness = 0.27, .damping = 6e-3, .maximum_torque = 0.1};
  options.wrist->orientation = Eigen::AngleAxisd(0.4, Vector3d::UnitX());
  SimulatedDevice device(options);
  (void)device.read();
  // The hand holds it where it began; a torque turns it until the hand's spring balances that.
  const Quaterniond start = device.true_orientation();
  for (int i = 0; i < 2000; ++i) {
    device.write_wrench({.torque = {0, 0, 0.05}});
    (void)device.read();
  }
  EXPECT_NEAR(turn_between(start, device.true_orientation()).z(), 0.05 / 0.27, 1e-6);
  for (int i = 0; i < 2000; ++i) {
    device.write_wrench({.torque = {0, 0, 0.11}});
    (void)device.read();
  }
  EXPECT_GT(turn_between(start, device.true_orientation()).norm(), 0.6);
}

TEST(HeldWrist, IsReadThroughEncoders) {
  SimulatedDeviceOptions options = loose();
  options.wrist->resolution = 0.01;
  options.wrist->velocity = {0, 1, 0};
  SimulatedDevice device(options);
  (void)device.read();
  double turned = 0;
  for (int i = 0; i < 100; ++i) {
    const DeviceState state = device.read();
    const double angle = turn_between(Quaterniond::Identity(), state.orientation).y();
    EXPECT_NEAR(angle, 0.01 * std::round(angle / 0.01), 1e-12);
    turned += 1e-3 * state.angular_velocity.y();
  }
  EXPECT_NEAR(turned, 0.1, 0.01);
}

TEST(HeldWrist, RefusesWhatIsNoWrist) {
  SimulatedDeviceOptions options = loose();
  options.wrist->inertia.y() = 0;
  EXPECT_THROW(SimulatedDevice{options}, Error);
  options = loose();
  options.wrist->hand.stiffness = -1;
  EXPECT_THROW(SimulatedDevice{options}, Error);
  options = loose();
  options.wrist->orientation.coeffs() *= 2;
  EXPECT_THROW(SimulatedDevice{options}, Error);
}

TEST(HeldWrist, FailsForATorqueThatIsNotFinite) {
  SimulatedDevice device(loose());
  (void)device.read();
  device.write_wrench({.torque = {0, std::nan(""), 0}});
  EXPECT_EQ(device.read().status, DeviceState::Status::failed);
  EXPECT_NE(device.reason(), "");
}

}  // namespace
}  // namespace palpate
