// A library with the names of OpenHaptics', its scheduler's thread, and two devices behind it, each
// a mass with friction: "Default Device", which can fail, and "Other". What is behind it is in
// fake_hd_library.hpp; the tests' own functions are in fake_hd_control.cpp.
#include "device/fake_hd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <thread>
#include <utility>

#include "device/fake_hd_library.hpp"

namespace {

using palpate::test::FakeHdLibrary;
using palpate::test::FakeMass;
using Three = FakeMass::Three;
using Lock = FakeHdLibrary::Lock;
using Device = FakeHdLibrary::Device;
using Failure = FakeHdLibrary::Failure;

constexpr double kMillimetre = palpate::test::FakeHdLibrary::kMillimetre;
constexpr unsigned kNone = FakeHdLibrary::kNone;

FakeHdLibrary& library = palpate::test::fake_hd_library();

}  // namespace

// NOLINTBEGIN(readability-identifier-naming)  the maker's names
extern "C" {

unsigned hdInitDevice(const char* name) {
  Lock lock = library.heard();
  library.require_stopped();
  const unsigned before = library.current;
  for (unsigned i = 0; i < library.devices.size(); ++i) {
    Device& device = library.devices[i];
    if (name != nullptr && device.name != name) continue;
    library.current = i;
    library.take_time(lock, device);
    const bool first = i == 0;
    const bool taken = device.is_open || (first && library.faults.busy);
    if (taken || (first && !library.faults.plugged)) {
      library.current = before;
      library.fail(taken ? 0x0301 : 0x0302);
      return kNone;
    }
    const unsigned meanwhile = first ? library.faults.failing_meanwhile : 0;
    if (meanwhile != 0) library.errors.push_back({meanwhile, 0, 1});
    device.is_open = true;
    device.let_go();
    return library.current = i;
  }
  library.fail(0x0303);
  return kNone;
}
void hdDisableDevice(unsigned handle) {
  Lock lock = library.heard();
  library.require_stopped();
  Device& device = library.devices[handle];
  device.is_open = device.forces_on = false;
  device.let_go();
  library.take_time(lock, device);
}
void hdMakeCurrentDevice(unsigned handle) {
  const Lock lock = library.heard();
  library.current = handle;
}
void hdEnable(unsigned capability) {
  const Lock lock = library.heard();
  if (capability == 0x4000) library.current_one().forces_on = true;
}
void hdDisable(unsigned capability) {
  const Lock lock = library.heard();
  if (capability != 0x4000) return;
  library.current_one().forces_on = false;
  library.current_one().let_go();
}
Failure hdGetError() {
  const Lock lock = library.heard();
  if (library.errors.empty()) return {0, 0, library.current};
  const Failure newest = library.errors.back();
  library.errors.pop_back();
  return newest;
}
const char* hdGetErrorString(unsigned code) {
  switch (code) {
    case 0x0200:
      return "HD_WARM_MOTORS";
    case 0x0201:
      return "HD_EXCEEDED_MAX_FORCE";
    case 0x0300:
      return "HD_DEVICE_FAULT";
    case 0x0301:
      return "HD_DEVICE_ALREADY_INITIATED";
    case 0x0302:
      return "HD_COMM_ERROR";
    default:
      return "";
  }
}
void hdBeginFrame(unsigned handle) {
  Lock lock = library.heard();
  library.current = handle;
  if (!library.current_one().is_open) library.fail(0x0104);
  if (!library.is_first()) return;
  library.is_stuck = library.faults.hangs;
  library.changed.notify_all();
  library.changed.wait(lock, [] { return !library.faults.hangs; });
  library.is_stuck = false;
  const unsigned code = library.faults.plugged ? library.faults.failing : 0x0302;
  if (code == 0) return;
  library.fail(code);
  library.current_one().forces_on = false;  // as the maker's library does
}
void hdEndFrame(unsigned handle) {
  const Lock lock = library.heard();
  Device& device = library.devices[handle];
  device.held = device.forces_on ? device.wanted : Three{};
}
void hdGetDoublev(unsigned what, double* numbers) {
  const Lock lock = library.heard();
  const FakeMass& hand = library.current_one().hand;
  for (std::size_t i = 0; i < 3; ++i) {
    if (what == 0x2050) numbers[i] = hand.place[i] / kMillimetre;
    if (what == 0x2051) numbers[i] = hand.velocity[i] / kMillimetre;
    if (what == 0x2605) numbers[i] = library.faults.temperature * (i == 2 ? 1 : 0.5);
  }
  if (what == 0x2050 && library.is_first() && library.faults.not_a_number) {
    numbers[1] = std::numeric_limits<double>::quiet_NaN();
  }
  if (what == 0x2052) {  // about y, column by column
    const double sine = std::sin(library.faults.turned);
    const double cosine = std::cos(library.faults.turned);
    const std::array<double, 16> all{cosine, 0, -sine,  0, 0, 1, 0, 0,
                                     sine,   0, cosine, 0, 0, 0, 0, 1};
    std::ranges::copy(all, numbers);
  }
  if (what == 0x2604) *numbers = library.faults.continuous_force;
  if (what == 0x2623) *numbers = library.faults.continuous_torque;
  if (what == 0x2602) *numbers = library.faults.stiffness;
}
void hdGetIntegerv(unsigned what, int* numbers) {
  const Lock lock = library.heard();
  if (what == 0x2000) *numbers = 2;
  if (what == 0x2555) *numbers = library.faults.styles;
}
const char* hdGetString(unsigned what) {
  const Lock lock = library.heard();
  if (what == 0x2501) return library.faults.model.data();
  library.fail(0x0100);  // older ones know no serial number
  return nullptr;
}
void hdSetDoublev(unsigned what, const double* numbers) {
  const Lock lock = library.heard();
  if (what == 0x2700) library.current_one().wanted = {numbers[0], numbers[1], numbers[2]};
  if (what == 0x2701) library.current_one().torque = {numbers[0], numbers[1], numbers[2]};
}
unsigned hdCheckCalibration() {
  const Lock lock = library.heard();
  return library.is_first() ? library.faults.calibration : 0x5000;
}
// Takes one style: automatic, or inkwell.
void hdUpdateCalibration(unsigned style) {
  const Lock lock = library.heard();
  const bool one = style == 2 || style == 4;
  if (one && library.faults.calibration == 0x5001) library.faults.calibration = 0x5000;
}
void hdStartScheduler() {
  const Lock lock = library.heard();
  library.runs = true;
  library.scheduler = std::jthread([](const std::stop_token& stop) { library.run(stop); });
}
// Waits for the callbacks of a tick that is under way.
void hdStopScheduler() {
  {
    const Lock lock = library.heard();
    library.runs = library.faults.hangs = false;
    library.changed.notify_all();
  }
  library.scheduler = {};
}
unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, unsigned short) {
  const Lock lock = library.heard();
  library.tasks.push_back({callback, data, ++library.scheduled});
  return library.scheduled;
}
void hdUnschedule(unsigned long handle) {
  const Lock lock = library.heard();
  std::erase_if(library.tasks, [handle](const auto& each) { return each.handle == handle; });
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming)
