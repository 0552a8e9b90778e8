#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate {

/// Requests of a servo's thread to the system.
struct RealtimeOptions {
  bool realtime_priority = true;      ///< SCHED_FIFO: before everything that is not real-time
  int priority = 80;                  ///< 1-99; above 50 it goes before most drivers' threads
  bool lock_memory = true;            ///< no page of the program is ever fetched from disk
  std::optional<int> processor = {};  ///< pin the thread to this one, from 0
};

/// Results of those requests. A servo runs without any of them, but not always on time.
struct RealtimeReport {
  /// Request and its result.
  struct Request {
    std::string what;  ///< "real-time priority 80 (SCHED_FIFO)"
    bool granted = false;
    std::string remedy;  ///< why it was not granted and how to permit it; empty when it was
  };

  std::vector<Request> requests;

  [[nodiscard]] bool all_granted() const noexcept;
};

/// A line for each request: what was granted, what was not, why and how to permit it.
[[nodiscard]] std::string in_words(const RealtimeReport& report);

/// Requests it for the calling thread; locked memory is the whole process's. Not real-time, never
/// throws for what is refused.
[[nodiscard]] RealtimeReport make_realtime(const RealtimeOptions& options);

/// Leaves a processor to the servo that is pinned there: the calling thread and those that it
/// starts from now on run on the others, and never sweep out the caches of a step. Refused where
/// there is no other.
[[nodiscard]] RealtimeReport::Request leave_processor(int processor);

/// A thread that steps a servo until it is destroyed, the device finishes, or it fails.
///
/// A device that keeps time paces it; any other is stepped by the clock, at absolute deadlines. A
/// late step is followed by the next one that is due and never by a burst. At the end, whatever
/// ended it, the device is given zero force.
class ServoThread {
 public:
  /// When the steps of a clock-paced loop are due: on a grid of whole periods. A step that comes
  /// late does not move the grid, and those that it made impossible are left out: after a gap there
  /// is one step and no burst.
  class Deadlines {
   public:
    /// The first step is due at `start`, s; `period` > 0, s.
    Deadlines(double start, double period) noexcept : start_(start), period_(period) {}

    /// When the next step is due, s.
    [[nodiscard]] double next() const noexcept {
      return start_ + static_cast<double>(index_) * period_;
    }

    /// A step begins at `now`. Returns how late it is, s; next() is then after `now`.
    double begin(double now) noexcept;

    /// The next step is due a period after `now`: where something else paces the steps.
    void restart(double now) noexcept;

    /// Steps that were left out because one before them was late.
    [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

   private:
    double start_;
    double period_;
    std::uint64_t index_ = 0;
    std::uint64_t skipped_ = 0;
  };

  static constexpr double kLeastRate = 500;    // Hz (judgement)
  static constexpr double kMostRate = 10'000;  // Hz (judgement)

  /// Starts, and returns when the system has answered the requests. Servo and clock outlive it, and
  /// nobody else steps the servo meanwhile. `rate`: steps a second, 500 to 10000 Hz; unset: what
  /// the device is made for. Devices that keep time (DeviceInfo::keeps_time) pace the thread
  /// themselves; theirs is then the rate.
  /// @throws Error when the rate is out of range or there is no thread to be had.
  ServoThread(Servo& servo, WaitingClock& clock, const RealtimeOptions& realtime = {},
              std::optional<double> rate = {});
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// Results of the requests to the system.
  [[nodiscard]] const RealtimeReport& realtime() const noexcept { return realtime_; }
  /// Steps a second, Hz.
  [[nodiscard]] double rate() const noexcept { return rate_; }
  /// False once the device has finished or failed; Servo::state() and Device::reason() report
  /// which.
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
