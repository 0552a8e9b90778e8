// The real-time contract of what goes on in OpenHaptics' scheduler: the driver's part of a tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "device/openhaptics_codes.hpp"
#include "device/openhaptics_frames.hpp"
#include "realtime/watch.hpp"

namespace palpate::realtime {
namespace {

using device::OpenHapticsFrames;
using device::OpenHapticsLibrary;
namespace hd = device::hd;

class StoppedClock final : public Clock {
 public:
  [[nodiscard]] double now() const noexcept override { return time; }
  double time = 0;
};

// What a library that costs nothing is asked and told.
struct {
  double place = 1;
  unsigned failure = 0;
  double force = 0;
} told;

OpenHapticsLibrary quick_library() {
  OpenHapticsLibrary library(PALPATE_FAKE_HD);
  library.make_current = library.begin_frame = library.end_frame = [](unsigned) {};
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
  OpenHapticsTick() { told = {}; }

  void tick(unsigned code = hd::kContinue) {
    Watch watch;
    const unsigned answer = frames_.tick();
    const Findings found = watch.stop();
    EXPECT_EQ(found.total(), 0) << found;
    EXPECT_EQ(answer, code);
  }

  StoppedClock clock_;
  OpenHapticsFrames frames_{quick_library(), 0, clock_};
};

TEST_F(OpenHapticsTick, KeepsTheContractInFramesAndFaults) {
  for (int i = 0; i < 100; ++i) {
    frames_.ask({0.5, 0, 0});
    tick();
    EXPECT_EQ(told.force, 0.5);
  }
  clock_.time = 1;
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
  tick();
  EXPECT_EQ(told.force, 0) << "after an error";
  frames_.end(0);
  tick(hd::kDone);
}

}  // namespace
}  // namespace palpate::realtime
