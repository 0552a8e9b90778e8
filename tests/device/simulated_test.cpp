#include "palpate/device/simulated.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

// A mass that nothing holds, nothing brakes and nothing rounds, until a test says otherwise.
SimulatedDeviceOptions bare() {
  SimulatedDeviceOptions options;
  options.damping = 0;
  options.coulomb = 0;
  options.resolution = 0;
  options.delay = 0;
  options.hand = {0, 0};
  return options;
}

// Runs `steps` steps against a force that depends on the state read; returns the last state read.
template <class Force>
DeviceState run(SimulatedDevice& device, int steps, const Force& force) {
  DeviceState state;
  for (int i = 0; i < steps; ++i) {
    state = device.read();
    device.write(force(state));
  }
  return state;
}

const auto kNoForce = [](const DeviceState&) { return Vector3d(0, 0, 0); };

TEST(SimulatedDevice, FreeDecayFollowsTheExponential) {
  SimulatedDeviceOptions options = bare();
  options.mass = 0.1;
  options.damping = 0.5;
  options.velocity = {0.4, -0.2, 0.1};
  SimulatedDevice device(options);
  const DeviceState state = run(device, 501, kNoForce);
  const double rate = options.damping / options.mass;
  const double decay = std::exp(-rate * state.time);
  EXPECT_NEAR(state.time, 0.5, 1e-12);
  EXPECT_LT((device.true_velocity() - decay * options.velocity).norm(), 1e-12);
  EXPECT_LT((device.true_position() - (1 - decay) / rate * options.velocity).norm(), 1e-12);
}

TEST(SimulatedDevice, HeldForceMovesAFreeMassAsAParabola) {
  SimulatedDevice device(bare());
  const DeviceState state =
      run(device, 201, [](const DeviceState&) { return Vector3d(0, 0, 0.3); });
  EXPECT_NEAR(device.true_position().z(), 0.5 * 0.3 / 0.1 * state.time * state.time, 1e-12);
}

TEST(SimulatedDevice, HandRingsAtItsFrequencyAndDampingRatio) {
  SimulatedDeviceOptions options = bare();
  options.mass = 0.1;
  options.hand = {300, 1};
  const Vector3d target(0, 0.01, 0);
  SimulatedDeviceOptions started = options;
  started.velocity = {0, 0.2, 0};
  SimulatedDevice device(started, {{0, target}, {10, target}});
  const DeviceState state = run(device, 301, kNoForce);
  const double decay = options.hand.damping / (2 * options.mass);
  const double omega = std::sqrt(options.hand.stiffness / options.mass - decay * decay);
  const double expected =
      target.y() + 0.2 / omega * std::exp(-decay * state.time) * std::sin(omega * state.time);
  EXPECT_NEAR(device.true_position().y(), expected, 1e-11);
}

TEST(SimulatedDevice, HandGivesWayAboveItsForce) {
  SimulatedDeviceOptions options = bare();
  options.damping = 0.5;
  options.hand = {300, 3, 6};
  SimulatedDevice device(options, {{0, {0, 0, 0}}, {0.5, {0, 0, -0.2}}, {5, {0, 0, -0.2}}});
  run(device, 3000,
      [&](const DeviceState& s) { return Vector3d(0, 0, -500 * std::min(0.0, s.position.z())); });
  EXPECT_NEAR(device.true_position().z(), -6. / 500, 1e-6);
}

TEST(SimulatedDevice, HandFollowsARampWithTheLagOfItsSpring) {
  SimulatedDeviceOptions options = bare();
  options.damping = 2;
  options.hand = {400, 5};
  const double speed = 0.1;
  SimulatedDevice device(options, {{0, {0, 0, 0}}, {2, {2 * speed, 0, 0}}});
  const DeviceState state = run(device, 1501, kNoForce);
  const double lag = options.damping * speed / options.hand.stiffness;
  EXPECT_NEAR(device.true_position().x(), speed * state.time - lag, 1e-10);
}

TEST(SimulatedDevice, RestsBetweenHandAndWallInProportionToTheirStiffness) {
  SimulatedDeviceOptions options = bare();
  options.damping = 0.5;
  options.hand = {300, 3};
  const double wall = 500;
  const Vector3d target(0, 0, -4e-3);
  SimulatedDevice device(options, {{0, target}, {10, target}});
  run(device, 4000,
      [&](const DeviceState& s) { return Vector3d(0, 0, -wall * std::min(0.0, s.position.z())); });
  EXPECT_NEAR(device.true_position().z(), 300 * target.z() / (300 + wall), 1e-9);
}

TEST(SimulatedDevice, DryFrictionHoldsSmallerForcesForever) {
  SimulatedDeviceOptions options = bare();
  options.coulomb = 0.05;
  SimulatedDevice device(options);
  run(device, 2000, [](const DeviceState&) { return Vector3d(0.03, 0, 0.0399); });
  EXPECT_EQ(device.true_position(), Vector3d::Zero());
  run(device, 100, [](const DeviceState&) { return Vector3d(0.03, 0, 0.0401); });
  EXPECT_GT(device.true_position().norm(), 0);
}

TEST(SimulatedDevice, DryFrictionStopsAMassAfterItsBrakingDistance) {
  SimulatedDeviceOptions options = bare();
  options.coulomb = 0.05;
  options.velocity = {0.06, 0, 0.08};
  SimulatedDevice device(options);
  run(device, 1000, kNoForce);
  const double braking = 0.1 * 0.1 / (2 * options.coulomb / options.mass);
  EXPECT_EQ(device.true_velocity(), Vector3d::Zero());
  EXPECT_LT((device.true_position() - braking * Vector3d(0.6, 0, 0.8)).norm(), 1e-12);
}

TEST(SimulatedDevice, SpringWithDryFrictionLosesTheSameAmplitudeInEveryHalfSwing) {
  SimulatedDeviceOptions options = bare();
  options.coulomb = 0.05;
  options.hand = {100, 0};
  const double omega = std::sqrt(options.hand.stiffness / options.mass);
  const double amplitude = 0.02;  // of the first half swing, about its displaced middle
  const double shift = options.coulomb / options.hand.stiffness;
  options.velocity = {amplitude * omega, 0, 0};
  SimulatedDevice device(options, {{0, {0, 0, 0}}, {10, {0, 0, 0}}});
  double previous = 0;
  std::vector<double> extremes;
  double before = 0;
  for (int i = 0; i < 700; ++i) {
    (void)device.read();
    device.write(Vector3d::Zero());
    const double x = device.true_position().x();
    if ((before - previous) * (x - before) < 0) extremes.push_back(std::abs(before));
    previous = before;
    before = x;
  }
  ASSERT_GT(extremes.size(), 4u);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(extremes[i - 1] - extremes[i], 2 * shift, 2e-5);  // sampled at 1 kHz
  }
}

TEST(SimulatedDevice, EncodersShowWholeStepsAndVelocityFromThem) {
  SimulatedDeviceOptions options = bare();
  options.resolution = 1e-4;
  options.velocity = {0.0301, 0, 0};
  SimulatedDevice device(options);
  Vector3d before = Vector3d::Zero();
  for (int i = 0; i < 50; ++i) {
    const DeviceState state = device.read();
    device.write(Vector3d::Zero());
    const double steps = state.position.x() / options.resolution;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::abs(state.position.x() - device.true_position().x()),
              0.5 * options.resolution + 1e-15);
    if (i > 0) {
      EXPECT_NEAR(state.velocity.x(), (state.position.x() - before.x()) * 1000, 1e-9);
    }
    before = state.position;
  }
}

TEST(SimulatedDevice, ForceActsAfterItsDelay) {
  for (int delay : {0, 1, 3}) {
    SimulatedDeviceOptions options = bare();
    options.delay = delay;
    SimulatedDevice device(options);
    int first = -1;
    for (int i = 0; i < 10; ++i) {
      (void)device.read();
      if (first < 0 && device.true_velocity().norm() > 0) first = i;
      device.write({1, 0, 0});
    }
    EXPECT_EQ(first, delay + 1);
  }
}

TEST(SimulatedDevice, MissedWriteGoesOnWithTheForceBefore) {
  SimulatedDevice device(bare());
  (void)device.read();
  device.write({1, 0, 0});
  for (int i = 0; i < 5; ++i) (void)device.read();
  EXPECT_NEAR(device.true_velocity().x(), 1 / 0.1 * 5e-3, 1e-14);
}

// Colgate and Schenkel: a device with viscous damping b is passive in a sampled wall of K up to
// 2 b / T, 2 b / (3 T) with a delay of one step. Pressed into it by a steady force it comes to rest
// below the limit and hops for ever above it.
TEST(SimulatedDevice, SampledWallIsQuietBelowColgatesLimitAndHopsAboveIt) {
  const auto swing_at_the_end = [](double stiffness, int delay) {
    SimulatedDeviceOptions options = bare();
    options.mass = 0.05;
    options.damping = 0.5;
    options.delay = delay;
    SimulatedDevice device(options);
    const auto wall = [&](const DeviceState& s) {
      return Vector3d(0, 0, -0.5 - stiffness * std::min(0.0, s.position.z()));
    };
    run(device, 12000, wall);
    double lowest = 1;
    double highest = -1;
    for (int i = 0; i < 500; ++i) {
      run(device, 1, wall);
      lowest = std::min(lowest, device.true_position().z());
      highest = std::max(highest, device.true_position().z());
    }
    return highest - lowest;
  };
  EXPECT_LT(swing_at_the_end(0.6 * 1000, 0), 1e-6);
  EXPECT_GT(swing_at_the_end(1.1 * 1000, 0), 1e-5);
  EXPECT_LT(swing_at_the_end(0.6 * 1000 / 3, 1), 1e-6);
  EXPECT_GT(swing_at_the_end(1.1 * 1000 / 3, 1), 1e-5);
}

TEST(SimulatedDevice, SameInputSameBits) {
  const auto final_position = [] {
    SimulatedDeviceOptions options;
    SimulatedDevice device(options,
                           {{0, {0, 0, 0.01}}, {0.3, {0.02, 0, -0.01}}, {1, {0.05, 0.01, 0.02}}});
    run(device, 900,
        [](const DeviceState& s) { return Vector3d(0, 0, -500 * std::min(0.0, s.position.z())); });
    return device.true_position();
  };
  EXPECT_EQ(final_position(), final_position());
}

TEST(SimulatedDevice, IsFinishedAfterItsTarget) {
  SimulatedDevice device({}, {{0, {0, 0, 0}}, {0.01, {0.001, 0, 0}}});
  int steps = 0;
  while (device.read().status == DeviceState::Status::ok && steps < 100) {
    device.write(Vector3d::Zero());
    ++steps;
  }
  EXPECT_EQ(steps, 11);
}

TEST(SimulatedDevice, LongForcesAreShortenedAndWrongOnesLatch) {
  SimulatedDeviceOptions options = bare();
  options.maximum_force = 2;
  SimulatedDevice device(options);
  (void)device.read();
  device.write({300, 0, 400});
  (void)device.read();
  EXPECT_LT((device.true_velocity() - 1e-3 / 0.1 * Vector3d(1.2, 0, 1.6)).norm(), 1e-12);
  device.write({std::numeric_limits<double>::infinity(), 0, 0});
  EXPECT_EQ(device.read().status, DeviceState::Status::failed);
  EXPECT_NE(device.reason(), "");
}

TEST(SimulatedDevice, RefusesOptionsOutOfRange) {
  const auto with = [](auto change) {
    SimulatedDeviceOptions options;
    change(options);
    return options;
  };
  EXPECT_THROW(SimulatedDevice(with([](auto& o) { o.mass = 0; })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& o) { o.damping = -1; })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& o) { o.delay = 17; })), Error);
  EXPECT_THROW(SimulatedDevice(with([](auto& o) { o.rate = std::nan(""); })), Error);
  EXPECT_THROW(SimulatedDevice({}, {{1, {0, 0, 0}}, {0, {0, 0, 0}}}), Error);
}

TEST(SimulatedDevice, TargetOfOneRowIsOneStepAndNoTargetIsNoEnd) {
  SimulatedDevice one({}, {{0, {0.1, 0, 0}}});
  EXPECT_EQ(one.read().status, DeviceState::Status::ok);
  EXPECT_EQ(one.read().status, DeviceState::Status::finished);
  SimulatedDevice free;
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(free.read().status, DeviceState::Status::ok);
}

TEST(SimulatedDevice, DurationThatWasGivenWins) {
  SimulatedDevice device({.duration = 0.01}, {{0, {0, 0, 0}}, {1, {0.1, 0, 0}}});
  for (int i = 0; i <= 10; ++i) EXPECT_EQ(device.read().status, DeviceState::Status::ok) << i;
  EXPECT_EQ(device.read().status, DeviceState::Status::finished);
}

}  // namespace
}  // namespace palpate
