#pragma once

namespace palpate {

/// Where time comes from. Everything that needs the time of day of a run is given one.
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

/// The host's monotonic clock.
class SteadyClock final : public Clock {
 public:
  [[nodiscard]] double now() const noexcept override;
};

}  // namespace palpate
