#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>

#include "palpate/base/waiting_clock.hpp"
#include "palpate/servo/deadlines.hpp"
#include "palpate/servo/realtime.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate {

struct ServoThreadOptions {
  /// Steps a second, 500 to 10000 Hz; unset: what the device is made for. Devices that keep time
  /// (DeviceInfo::keeps_time) pace the thread themselves; theirs is then the rate.
  std::optional<double> rate = {};
  RealtimeOptions realtime = {};
};

/// A thread that steps a servo until it is destroyed, the device finishes, or it fails.
///
/// A device that keeps time paces it; any other is stepped by the clock, at absolute deadlines. A
/// late step is followed by the next one that is due and never by a burst. At the end, whatever
/// ended it, the device is given zero force.
class ServoThread {
 public:
  static constexpr double kLeastRate = 500;    // Hz
  static constexpr double kMostRate = 10'000;  // Hz

  /// Starts, and returns when the system has answered what was asked for. Servo and clock outlive
  /// it, and nobody else steps the servo meanwhile.
  /// @throws Error when the rate is out of range or there is no thread to be had.
  ServoThread(Servo& servo, WaitingClock& clock, const ServoThreadOptions& options = {});
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// What the system granted.
  [[nodiscard]] const RealtimeReport& realtime() const noexcept { return realtime_; }
  /// Steps a second, Hz.
  [[nodiscard]] double rate() const noexcept { return rate_; }
  /// False once the device has finished or failed; Servo::state() and Device::reason() say which.
  [[nodiscard]] bool running() const noexcept { return running_.load(); }
  /// Steps that were left out because the one before came too late.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_.load(); }

  /// Ends the thread: zero force. Called by the destructor.
  void stop();

 private:
  void run(const std::stop_token& stop) noexcept;
  bool step(Deadlines& deadlines) noexcept;

  Servo& servo_;
  WaitingClock& clock_;
  double rate_;
  RealtimeReport realtime_;
  std::atomic<bool> running_{true};
  std::atomic<std::uint64_t> skipped_{0};
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
