#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "device/asker.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::Asker;
using test::kAskedEvery;

// A second along x at 5 cm/s and back.
Trajectory there_and_back() {
  return {{0, {0, 0, 0}}, {1, {0.05, 0, 0}}, {2, {0, 0, 0}}};
}

TEST(TeleoperatedHand, PlaysItsTrajectoryAgainAndAgain) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, there_and_back());
  Asker asker(hand, Vector3d::Zero());
  EXPECT_NEAR(asker.ask_until(0.501).position.x(), 0.025, 1e-9);
  EXPECT_NEAR(asker.ask_until(1.501).position.x(), 0.025, 1e-9);
  EXPECT_NEAR(asker.ask_until(2.501).position.x(), 0.025, 0.05 * 2.5 * kAskedEvery);
  EXPECT_EQ(asker.ask().buttons, 0u);
  EXPECT_NEAR(asker.fastest(), 0.05, 1e-9);
}

TEST(TeleoperatedHand, ReturnsToTheStartOfAWayThatEndsElsewhere) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, {{3, {0, 0, 0}}, {4, {0.05, 0, 0}}}, {.travel_speed = 0.1});
  Asker asker(hand, Vector3d::Zero());
  EXPECT_NEAR(asker.follow_until(1.251).position.x(), 0.025, 0.1 * 3 * kAskedEvery)
      << "on its way back";
  const double stopping = 0.1 / (2 * TeleoperatedHandOptions().braking);  // s that it takes longer
  EXPECT_NEAR(asker.follow_until(2.001 + stopping).position.x(), 0.025, 0.05 * 4 * kAskedEvery)
      << "again";
}

TEST(TeleoperatedHand, FollowsWhoeverTakesItAndReturnsSomeTimeAfterItWasLetGo) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, there_and_back(),
                        {.speed = 0.4, .travel_speed = 0.4, .return_after = 1});
  const Vector3d place(-0.02, 0.03, 0.05);
  Asker asker(hand, place);
  asker.ask_until(0.5);
  const double left = 0.05 * 0.499;
  while (asker.now() < 1.5) {
    static_cast<void>(remote.move({place, 2}, asker.now()));
    const TargetSource::Target wish = asker.ask();
    ASSERT_EQ(wish.buttons, 2u);
  }
  EXPECT_EQ(asker.ask().position, place);
  remote.release();
  EXPECT_EQ(asker.ask_until(2.4).position, place) << "rests where it was let go";
  EXPECT_EQ(asker.ask_until(2.4).buttons, 0u);
  const Vector3d start(left, 0, 0);
  const double return_time = (place - start).norm() / 0.4;
  EXPECT_NEAR((asker.ask_until(2.51 + return_time).position - start).norm(), 0, 2e-3);
  EXPECT_NEAR(asker.ask_until(3.0 + return_time).position.x(), 0.05, 2e-3) << "explores again";
  EXPECT_LE(asker.fastest(), 0.4 + 1e-9);
}

// At 0.4 m/s the edge of a hand, 80 mm out, turns by 5 rad/s.
TEST(TeleoperatedHand, TurnsAndOpensAfterTheCommandsAndBackWhereItExploresAgain) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, there_and_back(), {.speed = 0.4, .return_after = 1});
  Asker asker(hand, Vector3d::Zero());
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(2, Vector3d::UnitX()));
  Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
  double fastest = 0;
  while (asker.now() < 0.5) {
    static_cast<void>(remote.move({.orientation = turned, .opening = 0.04}, asker.now()));
    const TargetSource::Target wish = asker.ask();
    fastest = std::max(fastest, last.angularDistance(wish.orientation) / kAskedEvery);
    ASSERT_LE(wish.opening, 0.4 * asker.now() + 1e-12);
    last = wish.orientation;
  }
  EXPECT_NEAR(fastest, 5, 1e-6);
  EXPECT_EQ(last.coeffs(), turned.coeffs());
  EXPECT_EQ(asker.ask().opening, 0.04);
  remote.release();
  EXPECT_EQ(asker.ask_until(1.4).orientation.coeffs(), turned.coeffs()) << "rests as it was left";
  EXPECT_EQ(asker.ask_until(2.2).orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_EQ(asker.ask().opening, 0);
}

TEST(TeleoperatedHand, NoPoseMakesItFasterThanItsSpeed) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, there_and_back(), {.speed = 0.3});
  Asker asker(hand, Vector3d::Zero());
  for (int i = 0; i < 400; ++i) {
    const double far = i % 3 == 0 ? 1e6 : -0.2;
    if (i % 4 == 0) static_cast<void>(remote.move({{far, 0.1 * i, 0}, 0}, asker.now()));
    if (i % 50 == 49) remote.release();
    asker.ask();
  }
  EXPECT_LE(asker.fastest(), 0.3 + 1e-9);
}

TEST(TeleoperatedHand, SilenceIsLettingGoAndTheHandCeasesToPull) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, {}, {.command_timeout = 0.1, .release_time = 0.05});
  Asker asker(hand, Vector3d::Zero());
  asker.ask();
  static_cast<void>(remote.move({{0.01, 0, 0}, 1}, 0));
  const TargetSource::Target held = asker.ask_until(0.1);
  EXPECT_EQ(held.position.x(), 0.01);
  EXPECT_EQ(held.buttons, 1u);
  const TargetSource::Target silent = asker.ask_until(0.12);
  EXPECT_EQ(silent.buttons, 0u);
  EXPECT_LT(asker.ask_until(0.7).position.x(), 1e-6);
}

TEST(TeleoperatedHand, AMouseThatRestsIsHeldWhileItsConnectionSaysSo) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote, there_and_back());
  Asker asker(hand, Vector3d::Zero());
  static_cast<void>(remote.move({{0.01, 0, 0}, 1}, 0));
  for (int i = 0; i < 5000; ++i) {
    if (i % 90 == 0) remote.keep_alive();
    ASSERT_EQ(asker.ask().buttons, 1u) << asker.now();
  }
  EXPECT_EQ(asker.ask().position, Vector3d(0.01, 0, 0));
}

// The surface at z = 0 pushes with 500 N/m, the hand pulls with 300 N/m.
Vector3d wall(const DeviceState& state) {
  return {0, 0, -500 * std::min(0.0, state.position.z())};
}

TEST(TeleoperatedHand, ASurfaceHoldsBackTheDeviceThatAMousePullsIntoIt) {
  RemoteTarget remote;
  TeleoperatedHand hand(remote);
  SimulatedDeviceOptions options;
  options.coulomb = 0;
  options.resolution = 0;
  options.position = {0, 0, 0.01};
  SimulatedDevice device(options, hand);
  for (int i = 0; i < 3000; ++i) {
    if (i % 16 == 0) static_cast<void>(remote.move({{0, 0, -8e-3}, 1}, i * kAskedEvery));
    device.write(wall(device.read()));
  }
  EXPECT_NEAR(device.true_position().z(), -8e-3 * 300 / 800, 1e-6);
  EXPECT_EQ(device.read().buttons, 1u);
  remote.release();
  for (int i = 0; i < 3000; ++i) device.write(wall(device.read()));
  EXPECT_GT(device.true_position().z(), -1e-4) << "nobody presses any more";
  EXPECT_LT(device.true_velocity().norm(), 1e-3);
  EXPECT_EQ(device.read().buttons, 0u);
}

TEST(TeleoperatedHand, SameWordsAtTheSameTimesSameBits) {
  const auto final_position = [] {
    RemoteTarget remote;
    TeleoperatedHand hand(remote, there_and_back(), {.return_after = 0.2});
    SimulatedDevice device({}, hand);
    for (int i = 0; i < 3000; ++i) {
      if (i > 700 && i < 1500 && i % 13 == 0) {
        static_cast<void>(remote.move({{0.01, 1e-5 * i, -4e-3}, 0}, i * kAskedEvery));
      }
      device.write(wall(device.read()));
    }
    return device.true_position();
  };
  EXPECT_EQ(final_position(), final_position());
}

class Lost final : public TargetSource {
 public:
  [[nodiscard]] TargetSource::Target target(double time,
                                            const Vector3d& position) noexcept override {
    return {time < 0.01 ? position : Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()),
            0};
  }
};

TEST(TeleoperatedHand, AGuideThatIsNotFiniteIsAFailureOfTheDevice) {
  Lost lost;
  SimulatedDevice device({}, lost);
  for (int i = 0; i < 10; ++i) ASSERT_EQ(device.read().status, DeviceState::Status::ok);
  EXPECT_EQ(device.read().status, DeviceState::Status::failed);
  EXPECT_TRUE(device.read().position.allFinite());
  EXPECT_NE(device.reason().find("target"), std::string::npos) << device.reason();
}

TEST(TeleoperatedHand, RefusesOptionsOutOfRange) {
  RemoteTarget remote;
  EXPECT_THROW(TeleoperatedHand(remote, {}, {.speed = 0}), Error);
  EXPECT_THROW(TeleoperatedHand(remote, {}, {.travel_speed = 0}), Error);
  EXPECT_THROW(TeleoperatedHand(remote, {}, {.force = 0}), Error);
  EXPECT_THROW(TeleoperatedHand(remote, {}, {.braking = 0}), Error);
  EXPECT_THROW(TeleoperatedHand(remote, {}, {.command_timeout = -1}), Error);
  EXPECT_THROW(TeleoperatedHand(remote, {}, {.release_time = std::nan("")}), Error);
  EXPECT_THROW(TeleoperatedHand(remote, {}, {.return_after = -1}), Error);
  EXPECT_THROW(TeleoperatedHand(remote, {{1, {0, 0, 0}}, {0, {0, 0, 0}}}), Error);
}

}  // namespace

}  // namespace palpate
