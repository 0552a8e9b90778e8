// A library with the names of OpenHaptics', its scheduler's thread, and two devices behind it, each
// a mass with friction: "Default Device", which can fail, and "Other". Functions fake_* are the
// tests'.
#include "device/fake_hd.hpp"

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "device/fake_mass.hpp"

namespace {

using palpate::test::FakeHd;
using palpate::test::FakeMass;
using Three = FakeMass::Three;
using Lock = std::unique_lock<std::mutex>;

constexpr double kTick = 1e-3;  // s
constexpr double kMillimetre = 1e-3;
constexpr unsigned kNone = 0xffffffff;

struct Device {
  std::string name;
  bool is_open = false;
  bool forces_on = false;
  Three wanted{};  // in this frame
  Three held{};    // by the motors
  FakeMass hand{};
};

struct Task {
  unsigned (*callback)(void*);
  void* data;
};

struct Failure {
  unsigned code;
  int detail;
  unsigned device;
};

struct Library {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::array<Device, 2> devices{Device{"Default Device"}, Device{"Other"}};
  FakeHd faults;
  std::vector<Failure> errors;
  std::vector<Task> tasks;
  unsigned current = kNone;
  bool runs_by_itself = true;
  int granted = 0;  // ticks
  bool runs = false;
  bool is_ticking = false;
  bool is_stuck = false;
  std::jthread scheduler;  // last: it uses all of the above
};

Library library;

void fail(unsigned code) {
  library.errors.push_back({code, 0, library.current});
}
bool is_first() {
  return library.current == 0;
}
Device* current() {
  return library.current < library.devices.size() ? &library.devices[library.current] : nullptr;
}

void tick(Lock& lock) {
  std::vector<Task> tasks = std::exchange(library.tasks, {});
  lock.unlock();
  std::erase_if(tasks, [](const Task& each) { return each.callback(each.data) == 0; });
  lock.lock();
  library.tasks.insert(library.tasks.begin(), tasks.begin(), tasks.end());
  for (Device& each : library.devices) each.hand.advance(kTick, each.held);
}

void run(const std::stop_token& stop) {
  Lock lock(library.mutex);
  const auto is_due = [] { return library.granted > 0 || library.runs_by_itself; };
  while (library.changed.wait(lock, stop, is_due) && !stop.stop_requested()) {
    const bool is_granted = library.granted > 0;
    library.is_ticking = true;
    tick(lock);
    library.is_ticking = false;
    if (is_granted) --library.granted;
    library.changed.notify_all();
    library.changed.wait_for(lock, stop, std::chrono::milliseconds(1),
                             [] { return !library.runs_by_itself; });
  }
}

void let_go(Device& device) {
  device.wanted = device.held = {};
}

}  // namespace

extern "C" {

unsigned hdInitDevice(const char* name) {
  const Lock lock(library.mutex);
  for (unsigned i = 0; i < library.devices.size(); ++i) {
    Device& device = library.devices[i];
    if (name != nullptr && device.name != name) continue;
    const bool first = i == 0;
    const bool taken = device.is_open || (first && library.faults.busy);
    if (taken || (first && !library.faults.plugged)) {
      fail(taken ? 0x0301 : 0x0302);
      return kNone;
    }
    device.is_open = true;
    let_go(device);
    return library.current = i;
  }
  fail(0x0303);
  return kNone;
}
void hdDisableDevice(unsigned handle) {
  const Lock lock(library.mutex);
  Device& device = library.devices[handle];
  device.is_open = device.forces_on = false;
  let_go(device);
}
void hdMakeCurrentDevice(unsigned handle) {
  const Lock lock(library.mutex);
  library.current = handle;
}
void hdEnable(unsigned capability) {
  const Lock lock(library.mutex);
  if (capability == 0x4000) current()->forces_on = true;
}
void hdDisable(unsigned capability) {
  const Lock lock(library.mutex);
  if (capability != 0x4000) return;
  current()->forces_on = false;
  let_go(*current());
}
Failure hdGetError() {
  const Lock lock(library.mutex);
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
  Lock lock(library.mutex);
  library.current = handle;
  if (!current()->is_open) fail(0x0104);
  if (!is_first()) return;
  library.is_stuck = library.faults.hangs;
  library.changed.notify_all();
  library.changed.wait(lock, [] { return !library.faults.hangs; });
  library.is_stuck = false;
  const unsigned code = library.faults.plugged ? library.faults.failing : 0x0302;
  if (code == 0) return;
  fail(code);
  current()->forces_on = false;  // as the maker's library does
}
void hdEndFrame(unsigned handle) {
  const Lock lock(library.mutex);
  Device& device = library.devices[handle];
  device.held = device.forces_on ? device.wanted : Three{};
}
void hdGetDoublev(unsigned what, double* numbers) {
  const Lock lock(library.mutex);
  const FakeMass& hand = current()->hand;
  for (std::size_t i = 0; i < 3; ++i) {
    if (what == 0x2050) numbers[i] = hand.place[i] / kMillimetre;
    if (what == 0x2051) numbers[i] = hand.velocity[i] / kMillimetre;
    if (what == 0x2605) numbers[i] = library.faults.temperature * (i == 2 ? 1 : 0.5);
  }
  if (what == 0x2050 && is_first() && library.faults.not_a_number) {
    numbers[1] = std::numeric_limits<double>::quiet_NaN();
  }
  if (what == 0x2604) *numbers = library.faults.continuous_force;
  if (what == 0x2602) *numbers = library.faults.stiffness;
}
void hdGetIntegerv(unsigned what, int* numbers) {
  const Lock lock(library.mutex);
  if (what == 0x2000) *numbers = 2;
  if (what == 0x2555) *numbers = library.faults.styles;
}
const char* hdGetString(unsigned what) {
  const Lock lock(library.mutex);
  if (what == 0x2501) return library.faults.model.data();
  fail(0x0100);  // older ones know no serial number
  return nullptr;
}
void hdSetDoublev(unsigned what, const double* numbers) {
  const Lock lock(library.mutex);
  if (what == 0x2700) current()->wanted = {numbers[0], numbers[1], numbers[2]};
}
unsigned hdCheckCalibration() {
  const Lock lock(library.mutex);
  return is_first() ? library.faults.calibration : 0x5000;
}
// Takes one style: automatic, or inkwell.
void hdUpdateCalibration(unsigned style) {
  const Lock lock(library.mutex);
  const bool one = style == 2 || style == 4;
  if (one && library.faults.calibration == 0x5001) library.faults.calibration = 0x5000;
}
void hdStartScheduler() {
  const Lock lock(library.mutex);
  library.runs = true;
  library.scheduler = std::jthread(run);
}
void hdStopScheduler() {
  {
    const Lock lock(library.mutex);
    library.runs = library.faults.hangs = false;
    library.changed.notify_all();
  }
  library.scheduler = {};
}
unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, unsigned short) {
  const Lock lock(library.mutex);
  library.tasks.push_back({callback, data});
  return library.tasks.size();
}

void fake_reset() {
  const Lock lock(library.mutex);
  library.faults = {};
  library.errors.clear();
  library.runs_by_itself = true;
  for (Device& each : library.devices) each.hand = {};
}
// Ticks at 1 kHz, or as fake_tick() tells.
void fake_by_itself(bool on) {
  Lock lock(library.mutex);
  library.runs_by_itself = on;
  library.changed.notify_all();
  if (!on) library.changed.wait(lock, [] { return !library.is_ticking; });
}
// Lets so many ticks pass, or as many as there are until it hangs.
void fake_tick(int count) {
  Lock lock(library.mutex);
  library.changed.wait(lock, [] { return !library.is_ticking || library.is_stuck; });
  library.granted = library.runs ? count : 0;
  library.changed.notify_all();
  library.changed.wait(lock, [] { return library.granted == 0 || library.is_stuck; });
}
void fake_set(const FakeHd* faults) {
  const Lock lock(library.mutex);
  library.faults = *faults;
  if (!faults->plugged) let_go(library.devices[0]);
  library.changed.notify_all();
}
// mm
void fake_place(double x, double y, double z) {
  const Lock lock(library.mutex);
  library.devices[0].hand = {.place = {x * kMillimetre, y * kMillimetre, z * kMillimetre}};
}
// What the first one's motors hold, N; the maker's axes.
void fake_force(double* force) {
  const Lock lock(library.mutex);
  for (std::size_t i = 0; i < 3; ++i) force[i] = library.devices[0].held[i];
}
bool fake_is_open() {
  const Lock lock(library.mutex);
  return library.devices[0].is_open;
}
bool fake_runs() {
  const Lock lock(library.mutex);
  return library.runs;
}

}  // extern "C"
