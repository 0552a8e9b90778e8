#pragma once

namespace palpate {

/// The time of a run, s. Everything that needs the time is given one.
class Clock {
 public:
  virtual ~Clock() = default;

  /// s since a start of its own; never goes back. May be called on any thread.
  [[nodiscard]] virtual double now() const noexcept = 0;

 protected:
  Clock() = default;
  Clock(const Clock&) = default;
  Clock& operator=(const Clock&) = default;
};

/// A clock that can be waited for.
class WaitingClock : public Clock {
 public:
  /// Returns at `time` (s, of now()) or later; at once when that has passed.
  virtual void wait_until(double time) noexcept = 0;

 protected:
  WaitingClock() = default;
  WaitingClock(const WaitingClock&) = default;
  WaitingClock& operator=(const WaitingClock&) = default;
};

/// The machine's monotonic clock. Waits for absolute times, so that what happens between reading
/// the clock and going to sleep adds no lateness.
class SteadyClock final : public WaitingClock {
 public:
  [[nodiscard]] double now() const noexcept override;
  void wait_until(double time) noexcept override;
};

/// Computing time that the calling thread has used, s: time in which other threads had the
/// processor does not count. Resolution is the system's, some nanoseconds; one call costs some
/// hundred. A system call: not for the inside of a servo step.
[[nodiscard]] double thread_cpu_seconds() noexcept;

}  // namespace palpate
