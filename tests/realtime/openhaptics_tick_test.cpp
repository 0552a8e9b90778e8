// The real-time contract of what goes on in OpenHaptics' scheduler: the driver's part of a tick.
#include <gtest/gtest.h>
#include <sys/syscall.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "device/hand_clock.hpp"
#include "device/openhaptics_library.hpp"
#include "device/openhaptics_scheduler.hpp"
#include "realtime/watch.hpp"

namespace palpate::realtime {
namespace {

using device::OpenHapticsFrames;
using device::OpenHapticsLibrary;
namespace hd = device::hd;

// What a library that costs nothing is asked and told.
struct {
  double place = 1;
  unsigned failure = 0;
  double force = 0;
  int frames = 0;
} told;

OpenHapticsLibrary quick_library() {
  OpenHapticsLibrary library(PALPATE_FAKE_HD);
  library.make_current = [](unsigned) {};
  library.begin_frame = [](unsigned) {};
  library.end_frame = [](unsigned) { ++told.frames; };
  library.enable = library.disable = library.update_calibration = [](unsigned) {};
  library.get_error = [] {
    const unsigned code = std::exchange(told.failure, 0u);
    return OpenHapticsLibrary::Failure{code, 0, 0};
  };
  library.get_numbers = [](unsigned what, double* numbers) {
    const int count = what == hd::kCurrentPosition || what == hd::kCurrentVelocity ? 3 : 1;
    std::fill_n(numbers, count, told.place);
  };
  library.get_integers = [](unsigned, int* number) { *number = 1; };
  library.get_name = [](unsigned) { return "Touch"; };
  library.set_numbers = [](unsigned, const double* force) { told.force = force[0]; };
  library.check_calibration = [] { return hd::kCalibrated; };
  return library;
}

class OpenHapticsTick : public testing::Test {
 protected:
  OpenHapticsTick() {
    told = {};
    errors_.open(0);
  }

  // A watched tick. It may wake who waits for it, and does nothing else that takes its time.
  void tick() {
    Watch watch;
    frames_.tick();
    const Findings found = watch.stop();
    const bool wakes = found.first_system_call == SYS_futex;
    EXPECT_EQ(found.total(), wakes ? 1 : 0) << found;
    if (wakes) ++woken_;
  }

  test::HandClock clock_;
  device::OpenHapticsErrors errors_;
  OpenHapticsFrames frames_{quick_library(), 0, clock_, errors_};
  int woken_ = 0;
};

TEST_F(OpenHapticsTick, KeepsTheContractWithATorque) {
  frames_.enable_torque();
  for (int i = 0; i < 100; ++i) {
    frames_.request({{0.5, 0, 0}, {0.25, 0, 0}, 0});
    tick();
    EXPECT_EQ(told.force, 250) << "mN m, told after the force";
  }
}

TEST_F(OpenHapticsTick, KeepsTheContractInFramesAndFaults) {
  for (int i = 0; i < 100; ++i) {
    frames_.request({.force = {0.5, 0, 0}});
    tick();
    EXPECT_EQ(told.force, 0.5);
  }
  clock_.time += 1;
  tick();
  EXPECT_EQ(told.force, 0) << "nobody speaks";
  frames_.request({.force = {0.5, 0, 0}});
  told.place = std::numeric_limits<double>::quiet_NaN();
  tick();
  EXPECT_EQ(told.force, 0) << "no place";
  told.place = 1;
  tick();
  EXPECT_EQ(told.force, 0.5);
  told.failure = hd::kCommunication;
  tick();
  EXPECT_EQ(told.force, 0) << "an error, in this very frame";
  tick();
  EXPECT_EQ(told.force, 0) << "after an error";
  EXPECT_EQ(woken_, 0) << "nobody waits";
}

TEST_F(OpenHapticsTick, KeepsTheContractAtRest) {
  frames_.request({.force = {0.5, 0, 0}});
  tick();
  frames_.rest();
  EXPECT_FALSE(frames_.is_at_rest()) << "it has not ticked yet";
  tick();
  EXPECT_TRUE(frames_.is_at_rest());
  EXPECT_EQ(told.force, 0);
  EXPECT_EQ(told.frames, 2);
  tick();
  EXPECT_EQ(told.frames, 2) << "one frame is enough";
  frames_.resume();
  tick();
  EXPECT_EQ(told.force, 0.5);
  EXPECT_FALSE(frames_.is_at_rest()) << "it has to come to rest anew";
  frames_.rest();
  tick();
  frames_.resume();
  frames_.rest();
  EXPECT_FALSE(frames_.is_at_rest()) << "also where no tick came between";
}

TEST_F(OpenHapticsTick, DoesNothingOnceItsDeviceIsBeingClosed) {
  tick();
  const int before = told.frames;
  frames_.end();
  tick();
  EXPECT_EQ(told.frames, before);
}

TEST_F(OpenHapticsTick, WakesWhoWaits) {
  constexpr int kExchanges = 100;
  int answered = 0;
  std::atomic<bool> done{false};
  std::jthread other([&] {
    for (int i = 0; i < kExchanges; ++i) {
      frames_.request({.force = {0.5, 0, 0}});
      if (frames_.answer(60)) ++answered;
    }
    done = true;
  });
  while (!done) {
    tick();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that it waits
  }
  other.join();
  EXPECT_EQ(answered, kExchanges);
  EXPECT_TRUE(woken_ > 0 || !can_trap_system_calls());
}

}  // namespace
}  // namespace palpate::realtime
