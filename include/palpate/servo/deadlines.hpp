#pragma once

#include <cstdint>

namespace palpate {

/// When the steps of a clock-paced loop are due: on a grid of whole periods. A step that comes late
/// does not move the grid, and those that it made impossible are left out: after a gap there is one
/// step and no burst.
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

}  // namespace palpate
