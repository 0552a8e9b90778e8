// The real-time contract of what goes on in OpenHaptics' scheduler: the driver's part of a tick.
#include <gtest/gtest.h>
#include <sys/syscall.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "device/hand_clock.hpp"
#include "device/openhaptics_codes.hpp"
#include "device/openhaptics_frames.hpp"
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
  OpenHapticsFrames* given_up = nullptr;  // in a frame that hangs
} told;

OpenHapticsLibrary quick_library() {
  OpenHapticsLibrary library(PALPATE_FAKE_HD);
  library.make_current = [](unsigned) {};
  library.begin_frame = [](unsigned) {
    if (told.given_up != nullptr) told.given_up->end(0);
  };
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
    common_.errors.open(0);
  }

  // A watched tick. It may wake who waits for it, and does nothing else that takes its time.
  unsigned tick() {
    Watch watch;
    const unsigned code = frames_.tick();
    const Findings found = watch.stop();
    const bool wakes = found.first_system_call == SYS_futex;
    EXPECT_EQ(found.total(), wakes ? 1 : 0) << found;
    if (wakes) ++woken_;
    return code;
  }

  test::HandClock clock_;
  device::OpenHapticsCommon common_;
  OpenHapticsFrames frames_{quick_library(), 0, clock_, common_};
  int woken_ = 0;
};

TEST_F(OpenHapticsTick, KeepsTheContractInFramesAndFaults) {
  for (int i = 0; i < 100; ++i) {
    frames_.ask({0.5, 0, 0});
    EXPECT_EQ(tick(), hd::kContinue);
    EXPECT_EQ(told.force, 0.5);
  }
  clock_.time += 1;
  tick();
  EXPECT_EQ(told.force, 0) << "nobody speaks";
  frames_.ask({0.5, 0, 0});
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

TEST_F(OpenHapticsTick, KeepsTheContractWhileItStandsStill) {
  frames_.ask({0.5, 0, 0});
  tick();
  {
    const device::FrameGate::Stillness stillness(common_.gate, 0);
    tick();
    EXPECT_EQ(told.force, 0);
    EXPECT_EQ(told.frames, 2);
    EXPECT_EQ(tick(), hd::kContinue);
    EXPECT_EQ(told.frames, 2);
  }
  tick();
  EXPECT_EQ(told.force, 0.5);
}

TEST_F(OpenHapticsTick, WakesWhoWaits) {
  constexpr int kExchanges = 100;
  int answered = 0;
  std::jthread other([&] {
    for (int i = 0; i < kExchanges; ++i) {
      frames_.ask({0.5, 0, 0});
      if (frames_.answer(60)) ++answered;
    }
    frames_.end(60);
  });
  while (tick() == hd::kContinue) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that it waits
  }
  other.join();
  EXPECT_EQ(answered, kExchanges);
  EXPECT_EQ(told.force, 0) << "the last frame's";
  EXPECT_TRUE(woken_ > 0 || !can_trap_system_calls());
}

TEST_F(OpenHapticsTick, SpeaksNoMoreOnceItIsGivenUp) {
  frames_.ask({0.5, 0, 0});
  tick();
  frames_.ask({0.7, 0, 0});
  told.given_up = &frames_;
  (void)frames_.tick();  // begins a frame, and hangs
  EXPECT_EQ(told.force, 0.5);
  EXPECT_EQ(told.frames, 1);
  EXPECT_EQ(tick(), hd::kDone);
  EXPECT_EQ(told.frames, 1);
}

}  // namespace
}  // namespace palpate::realtime
