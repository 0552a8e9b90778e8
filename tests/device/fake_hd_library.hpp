#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "device/fake_hd.hpp"
#include "device/fake_mass.hpp"

namespace palpate::test {

/// What is behind the functions of fake_hd.cpp: two devices, each a mass with friction, a
/// scheduler, and one list of errors for all.
struct FakeHdLibrary {
  using Lock = std::unique_lock<std::mutex>;
  using Three = FakeMass::Three;
  static constexpr unsigned kNone = 0xffffffff;
  static constexpr double kTick = 1e-3;        // s
  static constexpr double kMillimetre = 1e-3;  // m

  struct Device {
    std::string name;
    bool is_open = false;
    bool forces_on = false;
    Three wanted{};  // in this frame
    Three held{};    // by the motors
    Three torque{};  // in this frame, mN m
    FakeMass hand{};

    void let_go() { wanted = held = torque = {}; }
  };
  struct Task {
    unsigned (*callback)(void*);
    void* data;
    unsigned long handle;
  };
  struct Failure {
    unsigned code;
    int detail;
    unsigned device;
  };

  std::mutex mutex;
  std::condition_variable_any changed;
  std::array<Device, 2> devices{Device{"Default Device"}, Device{"Other"}};
  FakeHd faults;
  std::vector<Failure> errors;
  std::vector<Task> tasks;
  unsigned long scheduled = 0;  // so far
  unsigned current = kNone;
  bool runs_by_itself = true;
  int granted = 0;  // ticks
  bool runs = false;
  bool is_ticking = false;
  bool is_stuck = false;
  bool is_busy = false;    // opening or closing a device
  int disturbances = 0;    // calls for others and forces of others meanwhile, or while it runs
  std::jthread scheduler;  // last: it uses all of the above

  void run(const std::stop_token& stop);  // the scheduler
  [[nodiscard]] Lock heard();             // somebody calls
  // With the mutex.
  void tick(Lock& lock);
  void fail(unsigned code) { errors.push_back({code, 0, current}); }
  [[nodiscard]] bool is_first() const { return current == 0; }
  [[nodiscard]] Device& current_one() { return devices.at(current); }
  /// The maker's rule: no device is opened or closed while the scheduler runs.
  void require_stopped() { disturbances += runs ? 1 : 0; }
  /// What opening or closing a device takes; others may be heard meanwhile.
  void take_time(Lock& lock, const Device& device);
};

/// The one of this library.
FakeHdLibrary& fake_hd_library();

}  // namespace palpate::test
