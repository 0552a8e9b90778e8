#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "palpate/io/trajectory.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// Compares the forces that a trajectory holds with those that are rendered along it.
class MeasuredForces {
 public:
  static constexpr double kFelt = 0.05;  ///< N; judgement: below it a sensor's noise begins

  /// Every row of `trajectory`, which outlives it, has a force. `file` is its name.
  MeasuredForces(std::string file, const Trajectory& trajectory);

  /// The step of the next row.
  void add(const ServoState& step);

  struct Difference {
    std::size_t steps = 0;     ///< whose measured force was felt; of them
    double rms = 0;            ///< |F - F_measured|, N
    double median = 0;         ///< the same, N
    double direction = 0;      ///< angle between both where both were felt, RMS, degrees
    double only_measured = 0;  ///< share of all steps in which it was felt in the file alone
    double only_rendered = 0;  ///< or here alone
  };
  [[nodiscard]] Difference difference() const;

  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::string file_;
  const Trajectory* trajectory_;
  std::size_t steps_ = 0;
  std::vector<double> errors_;
  double angle_squares_ = 0;
  std::size_t angles_ = 0;
  std::size_t only_measured_ = 0;
  std::size_t only_rendered_ = 0;
};

}  // namespace palpate::app
