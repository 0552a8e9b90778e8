#pragma once

#include "palpate/base/clock.hpp"

namespace palpate {

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

/// The host's monotonic clock, the same time as SteadyClock's. Waits for absolute times, so that
/// what happens between reading the clock and going to sleep adds no lateness.
class SteadyWaitingClock final : public WaitingClock {
 public:
  [[nodiscard]] double now() const noexcept override { return clock_.now(); }
  void wait_until(double time) noexcept override;

 private:
  SteadyClock clock_;
};

}  // namespace palpate
