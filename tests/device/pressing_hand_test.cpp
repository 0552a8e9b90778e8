// How hard a hand of limited force presses a simulated device against a wall.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "palpate/device/simulated.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kWall = 500;  // N/m, below z = 0

// A hand that is told every 16 ms what to do above a wall, and how far and fast the device went.
struct Presser {
  RemoteTarget remote;
  TeleoperatedHand hand{remote, {}, {.speed = 2}};
  SimulatedDevice device{{.coulomb = 0, .resolution = 0, .position = {0, 0, 5e-3}}, hand};
  int step = 0;
  double deepest = 0;  // m, of the last call
  double fastest = 0;  // m/s, upwards

  // For a second; without a target it is let go.
  void press(const std::optional<TargetSource::Target>& target) {
    deepest = fastest = 0;
    if (!target) remote.release();
    for (const int end = step + 1000; step < end; ++step) {
      if (target && step % 16 == 0) static_cast<void>(remote.move(*target, 1e-3 * step));
      const double z = device.read().position.z();
      device.write({0, 0, -kWall * std::min(0.0, z)});
      deepest = std::max(deepest, -device.true_position().z());
      fastest = std::max(fastest, device.true_velocity().z());
    }
  }
};

TEST(PressingHand, ALimitedForceIsNotExceededWhileTheTargetMoves) {
  Presser one;
  one.press({{{0, 0, 5e-3}}});
  one.press({{{0, 0, -60e-3}, 0, 1}});
  // 1 N that falls 5 mm goes as deep as its work: K x^2 / 2 = F (h + x).
  EXPECT_LT(one.deepest, (1 + std::sqrt(1 + 2 * kWall * 5e-3)) / kWall);
  EXPECT_NEAR(one.device.true_position().z(), -1 / kWall, 1e-6);
  one.press({{{0, 0, -60e-3}, 0, 1.5}});
  EXPECT_LT(one.deepest, 1.5 / kWall + 1e-3) << "more force comes without a kick";
  EXPECT_NEAR(one.device.true_position().z(), -1.5 / kWall, 1e-6);
}

TEST(PressingHand, LettingGoOrLiftingAfterALimitedPressPressesNoHarder) {
  for (const bool lift : {false, true}) {
    Presser one;
    one.press({{{0, 0, 5e-3}}});
    one.press({{{0, 0, -20e-3}, 0, 1}});
    if (lift) {
      one.press({{{0, 0, 5e-3}}});
      EXPECT_NEAR(one.device.true_position().z(), 5e-3, 1e-6);
    } else {
      one.press({});
    }
    EXPECT_LT(one.deepest, 1 / kWall + 1e-5) << lift;
    EXPECT_LT(one.fastest, 0.3) << lift;
  }
}

TEST(PressingHand, ComesToRestAtItsTarget) {
  Presser one;
  one.device.write(Vector3d::Zero());
  one.press({{{0, 0, 0.5}}});
  one.press({{{0, 0, 5e-3}}});  // half a metre down, to 5 mm above the wall
  EXPECT_NEAR(one.device.true_position().z(), 5e-3, 1e-6);
  EXPECT_EQ(one.deepest, 0);
}

TEST(PressingHand, AForceThatIsNoneIsAFailureOfTheDevice) {
  struct Weak final : TargetSource {
    [[nodiscard]] Target target(double time, const Vector3d& /*position*/) noexcept override {
      return {.maximum_force = time < 0.01 ? 1.0 : -1.0};
    }
  } weak;
  SimulatedDevice device({}, weak);
  for (int i = 0; i < 10; ++i) ASSERT_EQ(device.read().status, DeviceState::Status::ok);
  EXPECT_EQ(device.read().status, DeviceState::Status::failed);
  EXPECT_TRUE(device.read().position.allFinite());
  EXPECT_NE(device.reason().find("force"), std::string::npos) << device.reason();
}

}  // namespace
}  // namespace palpate
