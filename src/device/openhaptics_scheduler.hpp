// Frames of devices, which OpenHaptics' scheduler runs: one for all devices of a program.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/latest.hpp"
#include "device/drivers.hpp"
#include "device/openhaptics_library.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/device/device.hpp"

namespace palpate::device {

/// Wakes a waiting thread from one that must not wait itself.
class Wakeup {
 public:
  Wakeup() noexcept { ::sem_init(&semaphore_, 0, 0); }
  ~Wakeup() { ::sem_destroy(&semaphore_); }
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  /// Wakes the thread that waits now, or the next one. Takes no lock. Any thread.
  void post() noexcept { ::sem_post(&semaphore_); }
  /// Returns at a post, at `end`, or after a signal.
  void wait_until(std::chrono::steady_clock::time_point end) noexcept {
    using std::chrono::duration_cast;
    const auto since = end.time_since_epoch();
    const auto whole = duration_cast<std::chrono::seconds>(since);
    const auto rest = duration_cast<std::chrono::nanoseconds>(since - whole);
    const timespec time{whole.count(), rest.count()};
    (void)::sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &time);
  }

 private:
  sem_t semaphore_{};
};

[[nodiscard]] inline std::chrono::steady_clock::duration seconds(double duration) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(duration));
}

/// An open device of the library, as frames use it, in metres and with z up. Bounded work.
struct OpenHapticsHand {
  OpenHapticsLibrary library;
  OpenHapticsLibrary::Device device;
  OpenHapticsErrors& errors;
  std::atomic<bool> turns{false};  ///< the device has motors for a torque

  void begin_frame() const noexcept {
    library.make_current(device);
    library.begin_frame(device);
  }
  void end_frame(const Wrench& wrench) const noexcept;
  /// The state without status and time. Within a frame, as the next.
  [[nodiscard]] DeviceState read() const noexcept;
  [[nodiscard]] Eigen::Quaterniond orientation() const noexcept;
  [[nodiscard]] double warmest_motor() const noexcept;
  [[nodiscard]] unsigned take_error() const noexcept { return errors.take(library, device); }
};

/// Frames of one device: the scheduler calls tick() at 1 kHz on its own thread; each call reads
/// the hand's position and applies the force that was requested last.
///
/// A tick does constant work; it takes no lock and no memory and waits for nothing but the device.
/// It keeps errors as numbers, for others to put into words. There is no force from the first error
/// on, none where the position is not finite, and none that was requested longer than kForceTimeout
/// ago.
class OpenHapticsFrames {
 public:
  static constexpr double kForceTimeout = 5e-3;  ///< s

  /// The result of the frame that took the last request.
  struct Answer {
    DeviceState state;                  // without status and time
    std::uint64_t number = 0;           // of the request
    unsigned failure = 0;               // the first error's code
    unsigned calibration = 0;           // hd::kCalibrated and the like
    std::optional<double> temperature;  // of the warmest motor at first; 1: as warm as allowed
  };

  /// `clock` is read in ticks, too; it and `errors` outlive this.
  OpenHapticsFrames(const OpenHapticsLibrary& library, OpenHapticsLibrary::Device device,
                    const Clock& clock, OpenHapticsErrors& errors)
      : hand_{library, device, errors}, clock_(clock) {}

  // For one other thread.
  /// Requests a force and a torque, N and N m, as the operator sits.
  void request(const Wrench& wrench) noexcept;
  /// From the next frame on torques are applied: the device has motors for them.
  void enable_torque() noexcept { hand_.turns = true; }
  /// Waits for the frame that takes the last request, no longer than `patience` (s) while the
  /// device is not at rest.
  [[nodiscard]] std::optional<Answer> answer(double patience) noexcept;
  /// The next frame calibrates the device again, in one of the styles that it supports.
  void calibrate(int styles) noexcept { calibrate_ = styles; }

  // For the thread that stops the scheduler.
  /// The next tick makes one frame without a force; later ones do nothing, until resume().
  void rest() noexcept {
    at_rest_ = false;
    runs_since_ = TimePoint::max();
  }
  [[nodiscard]] bool is_at_rest() const noexcept { return at_rest_; }
  void resume() noexcept { runs_since_ = std::chrono::steady_clock::now(); }
  /// The device is about to be closed: no tick does anything any more, not even one whose frame
  /// began before this.
  void end() noexcept { over_ = true; }

  /// Runs one frame. The scheduler's thread.
  void tick() noexcept;

 private:
  using TimePoint = std::chrono::steady_clock::time_point;
  struct Wanted {
    Wrench wrench;
    double time = 0;  // s
    std::uint64_t number = 0;
  };

  void frame() noexcept;
  void frame_without_force() noexcept;
  void read() noexcept;
  [[nodiscard]] Wrench permitted(const DeviceState& state) const noexcept;
  void keep_failure() noexcept;

  OpenHapticsHand hand_;
  const Clock& clock_;

  // Used by the scheduler's thread alone.
  Wanted taken_;
  Answer newest_;

  std::uint64_t requested_ = 0;  // of the other thread

  // Between them.
  Latest<Wanted> wanted_;
  Latest<Answer> answers_;
  std::atomic<int> calibrate_{0};
  std::atomic<TimePoint> runs_since_{TimePoint{}};  // max(): it rests
  std::atomic<bool> at_rest_{false};
  std::atomic<bool> over_{false};
  Wakeup wakeup_;
};

/// An open device whose frames run in the scheduler.
///
/// The maker's rule: devices are opened and closed while the scheduler is stopped. A thread that
/// does so first has all other devices make a frame without a force, since it is not documented
/// whether a device holds its last force while no frames come. Any thread.
class OpenHapticsSession {
 public:
  static constexpr double kPatience = 0.5;  ///< s for the other devices to come to rest
  /// s before a device is opened again while others are in use, as that takes their force.
  static constexpr double kInterval = 10;

  /// `configuration`: the device's name in the maker's set-up. `clock` outlives this.
  /// @throws Error that states why it does not open.
  OpenHapticsSession(const OpenHapticsLibrary& library, const std::string& configuration,
                     const Clock& clock);
  ~OpenHapticsSession();
  OpenHapticsSession(const OpenHapticsSession&) = delete;
  OpenHapticsSession& operator=(const OpenHapticsSession&) = delete;

  [[nodiscard]] OpenHapticsFrames& frames() noexcept { return *frames_; }
  [[nodiscard]] const OpenHapticsFacts& facts() const noexcept { return facts_; }
  /// An error of this device that no frame has met; hd::kSuccess: none.
  [[nodiscard]] unsigned take_error() const noexcept;

 private:
  void require_interval(double now) const;
  void open(const std::string& configuration);
  [[noreturn]] void fail(const std::string& words) const;

  OpenHapticsLibrary library_;
  std::string name_;
  OpenHapticsLibrary::Device device_ = hd::kNoDevice;
  OpenHapticsFacts facts_;
  std::unique_ptr<OpenHapticsFrames> frames_;
};

/// A Touch or a Phantom of 3D Systems, through the maker's library. An exchange leaves a force for
/// the scheduler's next frame and waits for the result of that frame (OpenHapticsFrames).
class OpenHapticsDriver final : public DeviceDriver {
 public:
  static constexpr const char* kDefault = "Default Device";
  static constexpr double kPatience = 0.5;  ///< s without a frame after which it is given up

  /// `name`: device: as the maker's set-up calls it, kDefault without; options: library=PATH,
  /// profile=NAME. `clock` outlives it.
  /// @throws Error that states why it does not open.
  OpenHapticsDriver(const DeviceName& name, const Clock& clock);

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceState exchange(const Eigen::Vector3d& force) override {
    return exchange_wrench({.force = force});
  }
  [[nodiscard]] DeviceState exchange_wrench(const Wrench& wrench) override;

  // The two halves of an exchange.
  void request(const Wrench& wrench) noexcept { session_.frames().request(wrench); }
  /// @throws Error as exchange().
  [[nodiscard]] DeviceState answer() { return checked_answer().state; }

 private:
  void prepare();
  [[nodiscard]] OpenHapticsFrames::Answer checked_answer();
  [[noreturn]] void fail(const std::string& words) const;

  OpenHapticsLibrary library_;
  DeviceInfo info_;
  OpenHapticsSession session_;
};

}  // namespace palpate::device
