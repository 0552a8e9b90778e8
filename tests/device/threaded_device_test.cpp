// Hardware that fails in every way that hardware does, in simulated time, and a thread of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "device/fake_hardware.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FakeDriver;
using test::FakeHardware;
using test::MovedClock;
using Fault = FakeHardware::Fault;

constexpr double kServoStep = 1e-3;         // of the servo, s
constexpr double kExchangePeriod = 0.5e-3;  // of the device's thread, s
constexpr double kReaction = 6e-3;   // within which the hardware has to be without a force, s
const Vector3d kPushForce(0, 0, 2);  // N

// A servo that pushes as soon as the hand is known, and a device's thread, in simulated time.
class ThreadedDeviceTest : public testing::Test {
 protected:
  ThreadedDevice& open() {
    return device_.emplace([this] { return std::make_unique<FakeDriver>(hardware_); }, clock_,
                           ThreadedDeviceOptions{.threaded = false});
  }

  // Half a servo's step; the servo steps at every second one.
  void advance() {
    const double next = clock_.now() + kExchangePeriod;
    device_->service();
    if (servo_runs_ && ++half_ % 2 == 0) step();
    clock_.wait_until(next);
    if (hardware_.force().norm() > 0) pushed_ = clock_.now();
    if (!device_->reason().empty()) reasons_.insert(device_->reason());
  }
  void step() {
    state_ = device_->read();
    device_->write(state_.status == DeviceState::Status::ok ? kPushForce : Vector3d::Zero().eval());
  }
  void run(double duration) {
    for (const double end = clock_.now() + duration; clock_.now() < end - 1e-9;) advance();
  }
  void push() {
    run(0.02);
    ASSERT_EQ(state_.status, DeviceState::Status::ok);
    ASSERT_EQ(hardware_.force(), kPushForce);
    reasons_.clear();
  }
  // When the last force was there, from `start` on, s.
  [[nodiscard]] double pushed_for(double start) const { return pushed_ - start; }
  void expect_lost_and_back(Fault fault, const char* word) {
    open();
    push();
    const double start = clock_.now();
    hardware_.set(fault);
    run(0.5);
    EXPECT_LE(pushed_for(start), kReaction);
    EXPECT_EQ(state_.status, DeviceState::Status::silent);
    EXPECT_EQ(state_.velocity.norm(), 0);
    ASSERT_EQ(reasons_.size(), 1u) << "one loss, one reason";
    EXPECT_NE(reasons_.begin()->find(word), std::string::npos) << *reasons_.begin();
    EXPECT_EQ(hardware_.closed(), 1);
    run(3);
    EXPECT_EQ(reasons_.size(), 1u) << "that it is not back yet is no news";
    hardware_.set(Fault::none);
    run(1.1);
    EXPECT_EQ(state_.status, DeviceState::Status::ok);
    EXPECT_EQ(hardware_.force(), kPushForce);
    EXPECT_EQ(device_->reason(), "");
  }

  MovedClock clock_;
  FakeHardware hardware_{clock_};
  std::optional<ThreadedDevice> device_;
  DeviceState state_;
  bool servo_runs_ = true;
  int half_ = 0;
  double pushed_ = 0;
  std::set<std::string> reasons_;
};

TEST_F(ThreadedDeviceTest, TellsThePlaceAndAppliesTheForce) {
  open();
  hardware_.move({0.01, 0.02, 0.03});
  push();
  EXPECT_EQ(state_.position, Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(state_.velocity, Vector3d(0, 0, -0.1));
  EXPECT_EQ(state_.buttons, 1u);
  EXPECT_EQ(state_.orientation.coeffs(), Eigen::Vector4d(0, 0.8, 0, 0.6));
  device_.reset();
  EXPECT_EQ(hardware_.force().norm(), 0);
  EXPECT_EQ(hardware_.closed(), 1);
}

TEST_F(ThreadedDeviceTest, TellsTheFirstPlaceAsSilentSoThatForcesBeginWhereTheHandIs) {
  open();
  EXPECT_EQ(device_->read().status, DeviceState::Status::silent);
  hardware_.move({0.03, 0, 0});
  device_->service();
  const DeviceState first = device_->read();
  EXPECT_EQ(first.status, DeviceState::Status::silent);
  EXPECT_EQ(first.position.x(), 0.03);
  device_->write(kPushForce);
  device_->service();
  EXPECT_EQ(hardware_.force().norm(), 0) << "nobody knew where the hand was";
  EXPECT_EQ(device_->read().status, DeviceState::Status::ok);
}

TEST_F(ThreadedDeviceTest, IsNotOpenedWhereThereIsNone) {
  for (const auto& [fault, word] :
       {std::pair(Fault::absent, "plug it in"), std::pair(Fault::busy, "end the other program"),
        std::pair(Fault::uncalibrated, "move it to its stops")}) {
    hardware_.set(fault);
    try {
      open();
      ADD_FAILURE() << word;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(hardware_.opened(), 0);
}

TEST_F(ThreadedDeviceTest, UnpluggedInTheMiddle) {
  expect_lost_and_back(Fault::absent, "plug it in");
}
TEST_F(ThreadedDeviceTest, TakenByAnotherProgram) {
  expect_lost_and_back(Fault::busy, "end the other program");
}
TEST_F(ThreadedDeviceTest, LosesItsCalibration) {
  expect_lost_and_back(Fault::uncalibrated, "move it to its stops");
}
TEST_F(ThreadedDeviceTest, AnswersWithAnError) {
  expect_lost_and_back(Fault::error, "switch it off and on");
}

TEST_F(ThreadedDeviceTest, PlaceThatIsNoNumberTakesTheForceAwayInTwoSteps) {
  open();
  for (const Fault fault : {Fault::not_a_number, Fault::not_a_turn}) {
    push();
    hardware_.set(fault);
    const double start = clock_.now();
    run(0.5);
    EXPECT_LE(pushed_for(start), 2 * kServoStep);
    EXPECT_TRUE(state_.position.allFinite() && state_.orientation.coeffs().allFinite());
    EXPECT_EQ(state_.status, DeviceState::Status::silent);
    ASSERT_TRUE(reasons_.size() == 1 &&
                reasons_.begin()->find("not a number") != std::string::npos);
    hardware_.set(Fault::none);
    run(1.1);
  }
}

// While a driver's call does not return, the hardware's own watchdog ends the force; the servo goes
// on meanwhile, and learns of it.
TEST_F(ThreadedDeviceTest, BlocksForAWhile) {
  open();
  push();
  const double start = clock_.now();
  hardware_.block(0.1);
  device_->service();
  ASSERT_NEAR(clock_.now(), start + 0.1, 1e-9);
  step();
  EXPECT_EQ(hardware_.force().norm(), 0) << "its watchdog";
  EXPECT_EQ(hardware_.closed(), 0) << "it did answer";
  run(0.02);
  EXPECT_EQ(hardware_.force(), kPushForce);
}

TEST_F(ThreadedDeviceTest, SilenceIsToldAndEndsSoftlyForWhoeverComputesForces) {
  open();
  push();
  const double start = clock_.now();  // half a step after the hand was heard
  while (clock_.now() < start + 0.1) {
    clock_.wait_until(clock_.now() + 0.8 * kServoStep);  // no turn: the device's thread waits
    step();
    ASSERT_EQ(state_.status == DeviceState::Status::ok, clock_.now() - start < 4.5e-3);
  }
  EXPECT_NE(device_->reason().find("cable"), std::string::npos) << device_->reason();
  hardware_.move({0.05, 0, 0});
  device_->service();
  EXPECT_EQ(hardware_.force().norm(), 0) << "the force of before the silence is gone";
  step();
  EXPECT_EQ(state_.status, DeviceState::Status::silent);
  EXPECT_EQ(state_.position.x(), 0.05);
  step();
  EXPECT_EQ(state_.status, DeviceState::Status::ok);
}

TEST_F(ThreadedDeviceTest, StuckServoIsNotFelt) {
  open();
  push();
  const double start = clock_.now();
  servo_runs_ = false;
  run(0.5);
  EXPECT_LE(pushed_for(start), kReaction);
  servo_runs_ = true;
  run(0.01);
  EXPECT_EQ(hardware_.force(), kPushForce);
}

TEST_F(ThreadedDeviceTest, ForceOfBeforeALossIsNotAppliedAfterIt) {
  open();
  push();
  servo_runs_ = false;  // it sees nothing of the loss
  hardware_.set(Fault::absent);
  device_->service();
  hardware_.set(Fault::none);
  clock_.wait_until(clock_.now() + 1);
  device_->service();  // opened again
  device_->write(kPushForce);
  device_->service();
  EXPECT_EQ(hardware_.force().norm(), 0) << "it answers a place of before";
}

TEST_F(ThreadedDeviceTest, AnotherDeviceInItsPlaceIsNotUsed) {
  open();
  push();
  hardware_.set(Fault::absent);
  run(0.01);
  hardware_.set(Fault::none);
  hardware_.rename("stronger");
  run(3);
  EXPECT_EQ(state_.status, DeviceState::Status::silent);
  EXPECT_NE(device_->reason().find("found stronger"), std::string::npos);
  EXPECT_EQ(hardware_.opened(), hardware_.closed());
}

TEST_F(ThreadedDeviceTest, ForceThatIsNotFiniteIsAFailure) {
  open();
  push();
  const double start = clock_.now();
  device_->write({0, std::nan(""), 0});
  run(0.05);
  EXPECT_LE(pushed_for(start), 2 * kServoStep);
  EXPECT_EQ(state_.status, DeviceState::Status::failed);
  EXPECT_NE(device_->reason().find("not finite"), std::string::npos);
  device_->write(kPushForce);
  run(0.05);
  EXPECT_EQ(hardware_.force().norm(), 0) << "latched";
}

TEST_F(ThreadedDeviceTest, ForceIsNoLongerThanTheHardwareBears) {
  open();
  push();
  device_->write({30, 0, -40});
  device_->service();
  EXPECT_TRUE(hardware_.force().isApprox(Vector3d(3, 0, -4)));
}

TEST_F(ThreadedDeviceTest, OptionsOutOfRangeAreRefused) {
  const auto with = [this](const ThreadedDeviceOptions& options) {
    ThreadedDevice device([this] { return std::make_unique<FakeDriver>(hardware_); }, clock_,
                          options);
  };
  EXPECT_THROW(with({.state_timeout = 0, .threaded = false}), Error);
  EXPECT_THROW(with({.force_timeout = -1, .threaded = false}), Error);
  EXPECT_THROW(with({.retry_interval = std::nan(""), .threaded = false}), Error);
}

// For the thread sanitizer, and that it works and ends at all.
TEST(ThreadedDeviceThread, FollowsFaultsAndEnds) {
  SteadyClock clock;
  FakeHardware hardware(clock);
  bool begun = false;
  {
    ThreadedDevice device([&] { return std::make_unique<FakeDriver>(hardware); }, clock,
                          {.retry_interval = 1e-3, .begin = [&begun] { begun = true; }});
    const auto step_until = [&](DeviceState::Status wanted) {
      DeviceState state;
      do {
        state = device.read();
        device.write(kPushForce);
        static_cast<void>(device.reason());
        clock.wait_until(clock.now() + 0.2e-3);
      } while (state.status != wanted);
      return state;
    };
    for (int i = 0; i < 20; ++i) {
      hardware.move({i * 1e-3, 0, 0});
      hardware.set(Fault::none);
      step_until(DeviceState::Status::ok);
      hardware.set(i % 2 == 0 ? Fault::absent : Fault::not_a_number);
      EXPECT_TRUE(step_until(DeviceState::Status::silent).position.allFinite());
    }
    EXPECT_GE(hardware.closed(), 1);
  }
  EXPECT_TRUE(begun);
  EXPECT_EQ(hardware.force().norm(), 0);
  EXPECT_EQ(hardware.opened(), hardware.closed());
}

}  // namespace
}  // namespace palpate
