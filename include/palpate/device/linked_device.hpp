#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "palpate/base/clock.hpp"
#include "palpate/base/latest.hpp"
#include "palpate/device/device.hpp"
#include "palpate/device/device_link.hpp"

namespace palpate {

struct LinkedDeviceOptions {
  /// s after which a place that was told is no longer the hand's; raised to 2.5 exchanges of slow
  /// devices.
  double stale = 5e-3;
  double deaf = 5e-3;    ///< s after which a written force is no longer applied: the servo is stuck
  double retry = 1;      ///< s between attempts to open again what was lost
  bool threaded = true;  ///< false: whoever made it calls turn(), as in simulated time
  /// Called first on the device's thread, to ask for a priority; does not throw.
  std::function<void()> begin = {};
};

/// Hardware behind a thread of its own, so that nothing that its driver does makes the servo wait.
///
/// The thread exchanges forces and places with the hardware at the hardware's rate. read() takes
/// the newest place, write() leaves a force for the next exchange; neither waits, allocates or
/// locks.
///
/// Hardware that is unplugged, fails, does not answer, or tells what is not finite or no hand's (a
/// place too far away, a speed too high, a leap from the place before) is no failure of the device:
/// the status is `silent`, no force is applied, and what was lost is opened again as soon as it is
/// back. The first place after a silence is told as `silent`, too, so that whoever computes forces
/// knows where the hand is before there is one; and a force is applied only to the connection whose
/// place it answers. `failed` and latched is a force that is not finite.
class LinkedDevice final : public Device {
 public:
  /// Opens a link, or throws Error that says why there is none.
  using Open = std::function<std::unique_ptr<DeviceLink>()>;

  /// Opens the device. `clock` outlives it; DeviceState::time is its time.
  /// @throws Error when `open` does, an option is out of range, or there is no thread to be had.
  LinkedDevice(Open open, WaitingClock& clock, LinkedDeviceOptions options = {});
  /// Zero force; the hardware is closed.
  ~LinkedDevice() override;
  LinkedDevice(const LinkedDevice&) = delete;
  LinkedDevice& operator=(const LinkedDevice&) = delete;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState read() noexcept override;
  void write(const Eigen::Vector3d& force) noexcept override;
  /// Also why the device is silent. Any thread but the servo's.
  [[nodiscard]] std::string reason() const override;

  /// How often hardware that was there was lost. Any thread.
  [[nodiscard]] std::uint64_t losses() const noexcept { return losses_.load(); }

  /// One exchange with the hardware or, where it is lost and it is time, an attempt to open it
  /// again. The device's thread calls this; whoever made the device without one does.
  void turn() noexcept;

 private:
  /// A connection's number, from 1 on; each one that is opened has the next.
  using Connection = std::uint32_t;
  static constexpr Connection kNone = 0;

  struct Heard {
    LinkReading reading;
    double asked = 0;  // s, when its exchange began
    double time = 0;   // s, when it came
    Connection connection = kNone;
  };
  struct Wanted {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    double time = 0;                // s, when it was written
    Connection connection = kNone;  // whose place it answers
  };

  void run(const std::stop_token& stop) noexcept;
  void exchange() noexcept;
  void check_way_to(const Heard& heard) const;
  void open_again() noexcept;
  void lose(const char* why) noexcept;
  [[nodiscard]] Eigen::Vector3d applicable(double now) const noexcept;

  Open open_;
  WaitingClock& clock_;
  LinkedDeviceOptions options_;

  // Of whoever calls turn().
  std::unique_ptr<DeviceLink> link_;  // null: lost
  DeviceInfo info_;                   // does not change; both read it
  Heard newest_;
  Connection connection_ = 1;
  double retry_at_ = 0;  // s

  // Of the servo's thread.
  DeviceState state_{.status = DeviceStatus::silent};
  Heard seen_;
  Connection placed_ = kNone;  // the connection whose hand was told in the last step

  // Between them.
  Latest<Heard> heard_;
  Latest<Wanted> wanted_;
  std::atomic<DeviceStatus> status_{DeviceStatus::silent};
  std::atomic<std::uint64_t> losses_{0};
  mutable std::mutex words_mutex_;  // the servo's thread never takes it
  std::string words_;               // why the hardware is lost; empty: it is there

  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
