// Places that a hand cannot have gone to, and hands that go as fast as hands do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "device/fake_hardware.hpp"
#include "device/fault_trial.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "support/snapshots.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FakeDriver;
using test::FakeHardware;
using test::MovedClock;

constexpr double kExchange = 0.5e-3;  // of FakeDriver, s
const Vector3d kHold(0, 0, 2);        // N

class ThreadedDeviceJump : public testing::Test {
 protected:
  void push() {
    trial_.run(0.05);
    ASSERT_TRUE(trial_.is_pushed());
    trial_.forget();
  }

  MovedClock clock_;
  FakeHardware hardware_{clock_};
  test::FaultTrial trial_{{.open = [this] { return std::make_unique<FakeDriver>(hardware_); },
                           .advance = [](double) {},
                           .force = [this] { return hardware_.force().norm(); },
                           .period = kExchange},
                          clock_,
                          kHold};
};

TEST_F(ThreadedDeviceJump, IsALossThatTellsHowFar) {
  push();
  const auto jump_to = [this](double x, const char* words) {
    trial_.expect_lost(
        words,
        [&](bool) {
          hardware_.move({x, 0, 0});
        },
        words);
  };
  jump_to(0.02, "jumped by 20.0 mm in 0.50 ms");
  jump_to(0, "jumped by 20.0 mm in 0.50 ms");
  jump_to(-1, "jumped by 1000.0 mm in 0.50 ms");
  EXPECT_EQ(hardware_.opened(), 4);
}

// 100 rad/s take it 0.05 rad in an exchange; the rest are readings that come more rarely.
TEST_F(ThreadedDeviceJump, OfAnOrientationIsALossToo) {
  push();
  const Eigen::Quaterniond start(0.6, 0, 0.8, 0);
  const auto turn_to = [&](double angle) {
    hardware_.turn(start * Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitX())));
  };
  turn_to(0.54);
  trial_.run(0.01);
  EXPECT_EQ(hardware_.opened(), 1);
  const char* const words = "orientation jumped by 0.6 rad in 0.50 ms";
  trial_.expect_lost(
      words, [&](bool) { turn_to(1.14); }, words);
}

// 10 m/s take it 5 mm in an exchange; the rest are the encoders' steps.
TEST_F(ThreadedDeviceJump, BeginsWhereNoHandGoes) {
  push();
  hardware_.move({5.4e-3, 0, 0});
  trial_.run(0.05);
  EXPECT_EQ(hardware_.closed(), 0);
  EXPECT_TRUE(trial_.is_pushed());
  hardware_.move({11e-3, 0, 0});
  trial_.run(0.05);
  EXPECT_EQ(hardware_.closed(), 1);
  EXPECT_TRUE(trial_.is_free());
}

TEST_F(ThreadedDeviceJump, AHandAtFiveMetresASecondIsNoJump) {
  push();
  for (int i = 0; i < 1000; ++i) {
    const double turned = 5 * kExchange * i / 0.2;
    hardware_.move({0.2 * std::cos(turned) - 0.2, 0.2 * std::sin(turned), 0});
    trial_.run(kExchange);
  }
  EXPECT_EQ(hardware_.closed(), 0);
  EXPECT_TRUE(trial_.is_pushed());
}

TEST_F(ThreadedDeviceJump, AHandThatWentOnWhileTheDriverHungIsNoJump) {
  push();
  hardware_.block(0.1);
  hardware_.move({0.4, 0, 0});
  trial_.run(0.05);  // it hangs longer
  trial_.run(0.05);
  EXPECT_EQ(hardware_.closed(), 0);
  EXPECT_TRUE(trial_.is_pushed());
}

// Where an exchange comes early, the device may have told its place of a period before all the
// same.
TEST_F(ThreadedDeviceJump, IsJudgedOverAPeriodAtLeast) {
  push();
  hardware_.move({2.5e-3, 0, 0});
  trial_.device().service();
  hardware_.move({5e-3, 0, 0});
  clock_.wait_until(clock_.now() + 0.1 * kExchange);
  trial_.device().service();
  EXPECT_EQ(hardware_.closed(), 0);
}

TEST_F(ThreadedDeviceJump, IsNoneFromOneConnectionToTheNext) {
  ThreadedDevice device([this] { return std::make_unique<FakeDriver>(hardware_); }, clock_,
                        {.retry_interval = kExchange, .threaded = false});
  device.service();
  hardware_.set(FakeHardware::Fault::error);
  device.service();
  ASSERT_EQ(hardware_.closed(), 1);
  hardware_.set(FakeHardware::Fault::none);
  hardware_.move({0.3, 0, 0});
  for (int i = 0; i < 5; ++i) {
    clock_.wait_until(clock_.now() + kExchange);
    device.service();
  }
  EXPECT_EQ(hardware_.closed(), 1) << device.reason();
  EXPECT_EQ(device.read().position.x(), 0.3);
}

// A driver whose exchanges take their time; where in it the place is taken nobody knows.
class LateDriver final : public DeviceDriver {
 public:
  LateDriver(MovedClock& clock, unsigned seed) : clock_(clock), random_(seed) {
    info_.name = "late";
    info_.maximum_force = 5;
    info_.rate = 1000;
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState exchange(const Vector3d&) override {
    wait();
    const DeviceState reading{.position = {place(clock_.now()), 0, 0}};
    wait();
    return reading;
  }

 private:
  void wait() {
    if (random_() % 3 == 0) clock_.wait_until(clock_.now() + pause_(random_));
  }
  // To and fro between 0 and 1 m, at 5 m/s.
  static double place(double time) {
    const double way = std::fmod(5 * time, 2);
    return std::min(way, 2 - way);
  }

  MovedClock& clock_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> pause_{0, 0.04};  // s
  DeviceInfo info_;
};

TEST(ThreadedDeviceLateness, TurnsNoHandsMotionIntoAJump) {
  MovedClock clock;
  int opened = 0;
  const auto open = [&] {
    ++opened;
    return std::make_unique<LateDriver>(clock, 7);
  };
  ThreadedDevice device(open, clock, {.threaded = false});
  for (int i = 0; i < 10'000; ++i) {
    device.service();
    clock.wait_until(clock.now() + 1e-3);
  }
  EXPECT_EQ(opened, 1) << device.reason();
}

// What a hand feels that presses on a sheet.
class JumpOnASheet : public testing::Test {
 protected:
  // Two exchanges and a step of the servo.
  double step(double z) {
    for (int k = 0; k < 2; ++k) {
      hardware_.move({0.3e-3, 0.4e-3, z});
      device_.service();
      clock_.wait_until(clock_.now() + kExchange);
    }
    servo_.tick(clock_.now());
    return hardware_.force().norm();
  }
  // The longest force on the way from one height to another.
  double go(double from, double to, double seconds) {
    double longest = 0;
    const int steps = static_cast<int>(std::lround(1000 * seconds));
    for (int i = 1; i <= steps; ++i) {
      longest = std::max(longest, step(from + (to - from) * i / steps));
    }
    return longest;
  }

  // A sheet at z = 0.
  static Scene& laid(Scene& scene) {
    scene.add("sheet").publish(test::still(test::plane(0)));
    return scene;
  }

  MovedClock clock_;
  FakeHardware hardware_{clock_};
  ThreadedDevice device_{[this] { return std::make_unique<FakeDriver>(hardware_); }, clock_,
                         ThreadedDeviceOptions{.threaded = false}};
  Scene scene_;
  Servo servo_{device_, laid(scene_)};
};

TEST_F(JumpOnASheet, IsNotFelt) {
  constexpr double kPressed = -2e-3;
  go(5e-3, 5e-3, 0.6);  // past the soft start
  go(5e-3, kPressed, 0.1);
  const double before = go(kPressed, kPressed, 0.02);
  ASSERT_GT(before, 0.8);
  double longest = step(kPressed - 20e-3);
  longest = std::max(longest, go(kPressed, kPressed, 6e-3));
  EXPECT_LE(longest, before + 1e-3);
  EXPECT_EQ(go(kPressed, kPressed, 0.9), 0) << "it is lost";
  EXPECT_NE(device_.reason().find("20.0 mm"), std::string::npos) << device_.reason();
  double last = 0;
  double most_in_a_step = 0;
  for (int i = 0; i < 700; ++i) {
    const double force = step(kPressed);
    most_in_a_step = std::max(most_in_a_step, force - last);
    last = force;
  }
  EXPECT_EQ(device_.reason(), "");
  EXPECT_EQ(servo_.state().device, DeviceState::Status::ok);
  EXPECT_LE(most_in_a_step, 1.1 * before * 1e-3 / servo_.options().guard.soft_start);
  go(kPressed, 5e-3, 0.1);
  go(5e-3, 5e-3, 0.6);
  go(5e-3, kPressed, 0.1);
  EXPECT_NEAR(go(kPressed, kPressed, 0.02), before, 0.01) << "as before";
}

using Eigen::Vector3d;
using test::MovedClock;

// Tells when it lets go of the motors, and fails in its first exchange.
class FailingDriver final : public DeviceDriver {
 public:
  explicit FailingDriver(std::function<void()> lets_go) : lets_go_(std::move(lets_go)) {}
  ~FailingDriver() override { lets_go_(); }
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState exchange(const Vector3d& /*force*/) override {
    throw Error("its cable broke");
  }

 private:
  std::function<void()> lets_go_;
  DeviceInfo info_;
};

// Words take memory and a lock that others may hold.
TEST(ThreadedDeviceLoss, ForceIsGoneBeforeItIsSaidWhy) {
  MovedClock clock;
  std::optional<ThreadedDevice> device;
  std::string said_then;
  const auto open = [&] {
    return std::make_unique<FailingDriver>([&] { said_then = device->reason(); });
  };
  device.emplace(open, clock, ThreadedDeviceOptions{.threaded = false});
  device->service();
  EXPECT_NE(said_then.find("does not answer"), std::string::npos) << said_then;
  EXPECT_EQ(device->reason(), "its cable broke");
}

}  // namespace

}  // namespace palpate
