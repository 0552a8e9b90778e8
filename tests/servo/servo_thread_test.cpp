// The servo's thread on a clock that the test moves: nothing here waits for the time of day.
#include "palpate/servo/servo_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <thread>

#include "palpate/base/error.hpp"
#include "servo/servo_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using test::FreeDevice;

// Every wait takes the clock to where it was asked for, and `late` further.
class FakeClock final : public WaitingClock {
 public:
  explicit FakeClock(std::function<double(int)> late = {}) : late_(std::move(late)) {}

  [[nodiscard]] double now() const noexcept override { return now_; }
  void wait_until(double time) noexcept override {
    now_ = std::max(now_.load(), time) + (late_ ? late_(waits_) : 0.0);
    ++waits_;
  }

 private:
  std::function<double(int)> late_;
  std::atomic<double> now_ = 100;
  int waits_ = 0;
};

RealtimeOptions modest() {
  return {.realtime_priority = false, .lock_memory = false};
}

void wait_for(const ServoThread& thread) {
  while (thread.running()) std::this_thread::yield();
}

TEST(ServoThread, StepsOnTheClocksGridUntilTheDeviceIsDone) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, -1e-3});
  device.finish_after(2001);
  Servo servo(device, scene, test::pushed_out());
  FakeClock clock;
  {
    const ServoThread thread(servo, clock, modest(), 2000);
    EXPECT_EQ(thread.rate(), 2000);
    wait_for(thread);
    EXPECT_EQ(thread.skipped(), 0u);
  }
  const ServoState state = servo.state();
  EXPECT_EQ(state.step, 2001u);
  EXPECT_NEAR(state.time, 101, 1e-9);
  EXPECT_NEAR(state.dt, 5e-4, 1e-9);
  EXPECT_EQ(servo.durations().lateness.longest, 0);
  EXPECT_EQ(servo.durations().computing.count, 2001u);
  EXPECT_EQ(state.guard.counts.silences, 0u);
  EXPECT_GT(state.force.norm(), 0.5);
  EXPECT_EQ(device.force(), Vector3d::Zero()) << "whatever ended it";
}

TEST(ServoThread, MakesNoBurstAfterAGap) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, -4e-3});
  device.finish_after(1000);
  Servo servo(device, scene, test::first_links());
  FakeClock clock([](int wait) { return wait == 500 ? 0.1 : 20e-6; });
  const ServoThread thread(servo, clock, modest());
  wait_for(thread);
  EXPECT_EQ(thread.skipped(), 100u);
  EXPECT_EQ(servo.state().guard.counts.silences, 1u);
  EXPECT_NEAR(servo.state().time, 101.099, 1e-4) << "a step a millisecond, before it and after";
  EXPECT_NEAR(servo.durations().lateness.longest, 0.1, 1e-6);
  EXPECT_NEAR(servo.durations().lateness.quantile(0.5), 20e-6, 1e-6);
}

TEST(ServoThread, IsPacedByADeviceThatKeepsTime) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, 5e-3});
  device.info().keeps_time = true;
  device.finish_after(1000);
  Servo servo(device, scene, test::first_links());
  FakeClock clock;
  const ServoThread thread(servo, clock, modest());
  wait_for(thread);
  EXPECT_EQ(clock.now(), 100) << "nobody waited";
  EXPECT_EQ(servo.state().step, 1000u);
}

TEST(ServoThread, EndsWithZeroForceWhenToldTo) {
  Scene scene;
  test::add_sheet(scene);
  FreeDevice device({0, 0, -1e-3});
  Servo servo(device, scene, test::pushed_out());
  FakeClock clock;
  ServoThread thread(servo, clock, modest());
  while (servo.state().step < 100) std::this_thread::yield();
  thread.stop();
  EXPECT_FALSE(thread.running());
  EXPECT_GT(servo.state().force.norm(), 0.5);
  EXPECT_EQ(device.force(), Vector3d::Zero());
  thread.stop();  // once more does no harm
}

TEST(ServoThread, EndsWhenTheDeviceFails) {
  Scene scene;
  FreeDevice device;
  device.state().status = DeviceState::Status::failed;
  Servo servo(device, scene, test::first_links());
  FakeClock clock;
  const ServoThread thread(servo, clock, modest());
  wait_for(thread);
  EXPECT_EQ(servo.state().guard.fault, Guard::Fault::device);
}

// Everything that other threads may do while it runs; for the thread sanitizer.
TEST(ServoThread, MayBeWatchedAndChangedWhileItRuns) {
  Scene scene;
  Source& source = test::add_sheet(scene);
  FreeDevice device({0, 0, -4e-3});
  Servo servo(device, scene, test::first_links());
  FakeClock clock;
  const ServoThread thread(servo, clock, modest());
  std::uint64_t before = 0;
  for (int i = 0; i < 200; ++i) {
    servo.set_contact({.stiffness = 100.0 + i});
    servo.pause(i % 7 == 0);
    if (i % 10 == 0) servo.reset();
    if (i % 20 == 0) source.publish(test::still(test::plane(1e-4 * i), clock.now()));
    const ServoState state = servo.state();
    EXPECT_GE(state.step, before);
    EXPECT_TRUE(state.force.allFinite());
    before = state.step;
    EXPECT_LE(servo.durations().computing.quantile(0.5), servo.durations().computing.longest);
    EXPECT_EQ(thread.skipped(), 0u);
  }
}

TEST(ServoThread, RefusesRatesThatNoServoHas) {
  Scene scene;
  FreeDevice device;
  Servo servo(device, scene, test::first_links());
  FakeClock clock;
  for (const double rate : {0.0, 499.0, 10'001.0, -1.0}) {
    EXPECT_THROW(ServoThread(servo, clock, modest(), rate), Error);
  }
  device.info().keeps_time = true;
  device.info().rate = 30;
  EXPECT_THROW(ServoThread(servo, clock, modest()), Error) << "too slow to feel anything by";
}

TEST(SteadyClock, WaitsAndNeverWakesEarly) {
  SteadyClock clock;
  const double before = SteadyClock().now();
  const double start = clock.now();
  EXPECT_LE(before, start) << "every one tells the same time";
  EXPECT_LE(start, SteadyClock().now());
  clock.wait_until(start + 2e-3);
  EXPECT_GE(clock.now(), start + 2e-3 - 1e-8);
  clock.wait_until(start);  // passed: at once
  clock.wait_until(-1);
}

}  // namespace
}  // namespace palpate
