#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/trajectory.hpp"
#include "palpate/scene/scene.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/servo_thread.hpp"
#include "servo_cost/counting_device.hpp"

/// A servo in real time whose steps are timed, and the hand that it follows.
namespace palpate::servo_cost {

constexpr double kServoRate = 1000;  ///< Hz; judgement: the usual rate of haptics

struct ServoRun {
  std::vector<double> computing;  ///< thread time of every step, s; in rising order
  Durations lateness;
  std::uint64_t steps = 0;
  std::uint64_t skipped = 0;
  std::uint64_t touching = 0;
  std::uint64_t faults = 0;
  std::int64_t lock_waits = 0;  ///< times the servo's thread slept for anything but the clock
  RealtimeReport realtime;
};

/// Steps, lateness, computing time, faults and waits, in a line.
[[nodiscard]] std::string in_words(const ServoRun& run);

/// A servo at 1 kHz in real time whose hand is scripted, and a note of its every step. For one run.
class PacedServo {
 public:
  PacedServo(Scene& scene, const Trajectory& hand, WaitingClock& clock);

  [[nodiscard]] Servo& servo() { return servo_; }
  /// Until the hand's way ends. `processor`: the servo's thread is pinned there.
  [[nodiscard]] ServoRun run(std::optional<int> processor);

 private:
  WaitingClock& clock_;
  ScriptedDevice script_;
  PacedDevice paced_;
  CountingDevice device_;
  ServoState::Queue steps_;
  Servo servo_;
};

/// A hand that explores what the first source of `scene` shows for `seconds`, always in the same
/// way.
[[nodiscard]] Trajectory hand_over(const Scene& scene, double seconds);

}  // namespace palpate::servo_cost
