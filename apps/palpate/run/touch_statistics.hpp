#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "palpate/device/device.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/servo.hpp"

namespace palpate::app {

/// Computing times, us.
struct StepTimes {
  double p50 = 0;
  double p99 = 0;
  double p999 = 0;
  double maximum = 0;
};

/// A note that some steps had.
struct CountedNote {
  const char* name;  ///< short, for data
  const char* text;  ///< what it means and what to do, for people
  std::size_t steps = 0;
};

/// Sums up a run, step by step. Forces are those that were felt.
class TouchStatistics {
 public:
  void add(const ServoState& step);

  [[nodiscard]] std::size_t steps() const { return steps_; }
  /// Simulated time from the first to the last step, s.
  [[nodiscard]] double duration() const { return last_.time - first_time_; }
  /// Times that touching began.
  [[nodiscard]] std::size_t contacts() const { return contacts_; }
  /// Steps with touch.
  [[nodiscard]] std::size_t touching() const { return touching_; }
  /// Longest force, N.
  [[nodiscard]] double largest_force() const { return largest_.force; }
  /// Largest change of the force from one step to the next, N.
  [[nodiscard]] double largest_jump() const { return largest_.jump; }
  /// Longest torque of a tool that turns, N m, and largest force on its opening, N.
  [[nodiscard]] double largest_torque() const { return largest_.torque; }
  [[nodiscard]] double largest_grip() const { return largest_.grip; }
  /// What a device gives the hand that holds each force until the next step, J: the sum of
  /// F_k . (h_{k+1} - h_k). Negative: taken from the hand. Sampling alone makes it positive: of a
  /// spring, by K / 2 |h_{k+1} - h_k|^2 a step.
  [[nodiscard]] double given_energy() const { return given_energy_; }
  /// The integral of F . dh along the path by trapezoids, J, as if forces changed without steps. It
  /// shows whether the surface is passive, not whether a device is.
  [[nodiscard]] double path_energy() const { return path_energy_; }
  /// Notes of contacts and of the field, counted. `of_tool`: of a hand that holds a tool that
  /// turns.
  [[nodiscard]] std::vector<CountedNote> notes(bool of_tool) const;
  /// Steps that the proxy could not take.
  [[nodiscard]] std::size_t faults() const { return faults_; }
  /// Quantiles of computing times to 5 %, and the exact maximum; zero without steps.
  [[nodiscard]] StepTimes times() const;

 private:
  struct Largest {
    double force = 0;   // N
    double jump = 0;    // N
    double torque = 0;  // N m
    double grip = 0;    // N
  };

  std::size_t steps_ = 0;
  Durations times_;
  ServoState last_;
  double first_time_ = 0;
  std::size_t contacts_ = 0;
  std::size_t touching_ = 0;
  Largest largest_;
  double given_energy_ = 0;
  double path_energy_ = 0;
  std::size_t faults_ = 0;
  std::array<std::size_t, 17> notes_{};  // steps with each
};

/// What a guard would have made of a run that has none: its slew and its clamp, along the path of
/// the hand without them. Damper and soft start, which change every force a little, are left out.
class Unguarded {
 public:
  /// With the limits that a run in real time would have. `scale` is the workspace's.
  Unguarded(const GuardOptions& guard, const DeviceInfo& device, double scale);

  void add(const ServoState& step);

  [[nodiscard]] const GuardOptions& limits() const { return guard_.options(); }
  /// `slewed` and `clamped` are the steps that would have been slowed and shortened.
  [[nodiscard]] const Guard::State::Counts& counts() const { return guard_.state().counts; }
  /// Largest change of the force, N, in a step that would have been slowed.
  [[nodiscard]] double largest_change() const { return largest_change_; }

 private:
  Guard guard_;
  ServoState last_;
  double largest_change_ = 0;
};

}  // namespace palpate::app
