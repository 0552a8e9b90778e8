#include "palpate/device/guided_hand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "palpate/base/error.hpp"
#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;  // s

// A second along x at 5 cm/s and back.
Trajectory there_and_back() {
  return {{0, {0, 0, 0}}, {1, {0.05, 0, 0}}, {2, {0, 0, 0}}};
}

// Asks a guided hand every millisecond and remembers its fastest step.
class Asker {
 public:
  Asker(GuidedHand& hand, const Vector3d& device) : hand_(hand), device_(device) {}

  HandWish ask() {
    const HandWish wish = hand_.wanted(now_, device_);
    if (step_ > 0) fastest_ = std::max(fastest_, (wish.position - last_.position).norm() / kStep);
    last_ = wish;
    now_ = ++step_ * kStep;
    return wish;
  }
  HandWish ask_until(double time) {
    while (now_ < time - 0.5 * kStep) ask();
    return last_;
  }

  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] double fastest() const { return fastest_; }
  void device_at(const Vector3d& position) { device_ = position; }

 private:
  GuidedHand& hand_;
  Vector3d device_;
  HandWish last_;
  double now_ = 0;
  double fastest_ = 0;
  int step_ = 0;
};

TEST(GuidedHand, PlaysItsTrajectoryAgainAndAgain) {
  RemoteHand remote;
  GuidedHand hand(remote, there_and_back());
  Asker asker(hand, Vector3d::Zero());
  EXPECT_NEAR(asker.ask_until(0.501).position.x(), 0.025, 1e-9);
  EXPECT_NEAR(asker.ask_until(1.501).position.x(), 0.025, 1e-9);
  EXPECT_NEAR(asker.ask_until(2.501).position.x(), 0.025, 0.05 * 2.5 * kStep);
  EXPECT_FALSE(hand.taken());
  EXPECT_NEAR(asker.fastest(), 0.05, 1e-9);
}

TEST(GuidedHand, ReturnsToTheStartOfAWayThatEndsElsewhere) {
  RemoteHand remote;
  GuidedHand hand(remote, {{3, {0, 0, 0}}, {4, {0.05, 0, 0}}}, {.speed = 0.1});
  Asker asker(hand, Vector3d::Zero());
  EXPECT_NEAR(asker.ask_until(1.251).position.x(), 0.025, 0.1 * 2 * kStep) << "on its way back";
  EXPECT_NEAR(asker.ask_until(2.001).position.x(), 0.025, 0.05 * 3 * kStep) << "again";
}

TEST(GuidedHand, FollowsWhoeverTakesItAndReturnsSomeTimeAfterItWasLetGo) {
  RemoteHand remote;
  GuidedHand hand(remote, there_and_back(), {.speed = 0.4, .return_after = 1});
  const Vector3d place(-0.02, 0.03, 0.05);
  Asker asker(hand, place);
  asker.ask_until(0.5);
  const double left = 0.05 * 0.499;
  while (asker.now() < 1.5) {
    static_cast<void>(remote.move({{place, 2}, asker.now()}));
    const HandWish wish = asker.ask();
    ASSERT_TRUE(hand.taken());
    ASSERT_EQ(wish.buttons, 2u);
  }
  EXPECT_EQ(asker.ask().position, place);
  remote.release();
  EXPECT_EQ(asker.ask_until(2.4).position, place) << "rests where it was let go";
  EXPECT_FALSE(hand.taken());
  const Vector3d start(left, 0, 0);
  const double return_time = (place - start).norm() / 0.4;
  EXPECT_NEAR((asker.ask_until(2.51 + return_time).position - start).norm(), 0, 2e-3);
  EXPECT_NEAR(asker.ask_until(3.0 + return_time).position.x(), 0.05, 2e-3) << "explores again";
  EXPECT_LE(asker.fastest(), 0.4 + 1e-9);
}

TEST(GuidedHand, NoPoseMakesItFasterThanItsSpeed) {
  RemoteHand remote;
  GuidedHand hand(remote, there_and_back(), {.speed = 0.3});
  Asker asker(hand, Vector3d::Zero());
  for (int i = 0; i < 400; ++i) {
    const double far = i % 3 == 0 ? 1e6 : -0.2;
    if (i % 4 == 0) static_cast<void>(remote.move({{{far, 0.1 * i, 0}, 0}, asker.now()}));
    if (i % 50 == 49) remote.release();
    asker.ask();
  }
  EXPECT_LE(asker.fastest(), 0.3 + 1e-9);
}

TEST(GuidedHand, SilenceIsLettingGoAndTheHandCeasesToPull) {
  RemoteHand remote;
  GuidedHand hand(remote, {}, {.silence = 0.1, .letting_go = 0.05});
  Asker asker(hand, Vector3d::Zero());
  asker.ask();
  static_cast<void>(remote.move({{{0.01, 0, 0}, 1}, 0}));
  EXPECT_EQ(asker.ask_until(0.1).position.x(), 0.01);
  EXPECT_TRUE(hand.taken());
  const HandWish silent = asker.ask_until(0.12);
  EXPECT_FALSE(hand.taken());
  EXPECT_EQ(silent.buttons, 0u);
  EXPECT_LT(asker.ask_until(0.7).position.x(), 1e-6);
}

TEST(GuidedHand, AMouseThatRestsIsHeldWhileItsConnectionSaysSo) {
  RemoteHand remote;
  GuidedHand hand(remote, there_and_back());
  Asker asker(hand, Vector3d::Zero());
  static_cast<void>(remote.move({{{0.01, 0, 0}, 0}, 0}));
  for (int i = 0; i < 5000; ++i) {
    if (i % 90 == 0) remote.keep();
    asker.ask();
    ASSERT_TRUE(hand.taken()) << asker.now();
  }
  EXPECT_EQ(asker.ask().position, Vector3d(0.01, 0, 0));
}

// The surface at z = 0 pushes with 500 N/m, the hand pulls with 300 N/m.
Vector3d wall(const DeviceState& state) {
  return {0, 0, -500 * std::min(0.0, state.position.z())};
}

TEST(GuidedHand, ASurfaceHoldsBackTheDeviceThatAMousePullsIntoIt) {
  RemoteHand remote;
  GuidedHand hand(remote);
  SimulatedDeviceOptions options;
  options.coulomb = 0;
  options.resolution = 0;
  options.position = {0, 0, 0.01};
  SimulatedDevice device(options, hand);
  for (int i = 0; i < 3000; ++i) {
    if (i % 16 == 0) static_cast<void>(remote.move({{{0, 0, -8e-3}, 1}, i * kStep}));
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

TEST(GuidedHand, SameWordsAtTheSameTimesSameBits) {
  const auto final_position = [] {
    RemoteHand remote;
    GuidedHand hand(remote, there_and_back(), {.return_after = 0.2});
    SimulatedDevice device({}, hand);
    for (int i = 0; i < 3000; ++i) {
      if (i > 700 && i < 1500 && i % 13 == 0) {
        static_cast<void>(remote.move({{{0.01, 1e-5 * i, -4e-3}, 0}, i * kStep}));
      }
      device.write(wall(device.read()));
    }
    return device.true_position();
  };
  EXPECT_EQ(final_position(), final_position());
}

class Lost final : public HandGuide {
 public:
  [[nodiscard]] HandWish wanted(double time, const Vector3d& position) noexcept override {
    return {time < 0.01 ? position : Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()),
            0};
  }
};

TEST(GuidedHand, AGuideThatIsNotFiniteIsAFailureOfTheDevice) {
  Lost lost;
  SimulatedDevice device({}, lost);
  for (int i = 0; i < 10; ++i) ASSERT_EQ(device.read().status, DeviceStatus::ok);
  EXPECT_EQ(device.read().status, DeviceStatus::failed);
  EXPECT_TRUE(device.read().position.allFinite());
  EXPECT_NE(device.reason().find("wanted"), std::string::npos) << device.reason();
}

TEST(GuidedHand, RefusesOptionsOutOfRange) {
  RemoteHand remote;
  EXPECT_THROW(GuidedHand(remote, {}, {.speed = 0}), Error);
  EXPECT_THROW(GuidedHand(remote, {}, {.silence = -1}), Error);
  EXPECT_THROW(GuidedHand(remote, {}, {.letting_go = std::nan("")}), Error);
  EXPECT_THROW(GuidedHand(remote, {}, {.return_after = -1}), Error);
  EXPECT_THROW(GuidedHand(remote, {{1, {0, 0, 0}}, {0, {0, 0, 0}}}), Error);
}

}  // namespace
}  // namespace palpate
