#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "servo_cost/paced_servo.hpp"

namespace palpate::servo_cost {

/// The quantile of values in rising order; 0 of none.
[[nodiscard]] double quantile(const std::vector<double>& values, double share);

[[nodiscard]] double median(std::vector<double> values);

/// Rises of a step's computing time with something beside it over without: ratios less 1, one of
/// each pair of runs that took turns.
class Rises {
 public:
  void add(const ServoRun& with, const ServoRun& without);

  [[nodiscard]] std::size_t pairs() const { return p50_.size(); }
  [[nodiscard]] double p50() const { return median(p50_); }
  [[nodiscard]] double p99() const { return median(p99_); }
  /// In all runs with it.
  [[nodiscard]] std::int64_t lock_waits() const { return lock_waits_; }
  /// At most 10 % at the median step, 20 % at the 99th percentile, and never a wait for a lock.
  [[nodiscard]] bool met() const;

 private:
  std::vector<double> p50_, p99_;
  std::int64_t lock_waits_ = 0;
};

/// "| against | p50 | p99 |", and a row of it.
[[nodiscard]] std::string rises_head();
[[nodiscard]] std::string row_of(const Rises& rises, std::string_view against);

}  // namespace palpate::servo_cost
