// Runs a servo in real time and collects the times of its steps.
#include "servo_cost/paced_servo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "device/explore.hpp"
#include "palpate/servo/servo_thread.hpp"
#include "servo_cost/rises.hpp"

namespace palpate::servo_cost {

namespace {

constexpr std::size_t kMostWaiting = 1 << 17;  // steps; derived: two minutes at 1 kHz
constexpr double kRegion = 0.15;  // m, that the hand explores; judgement: in sight of all cameras
constexpr double kDepth = 3e-3;   // m; judgement: as in table A

ServoOptions noted_by(ServoState::Queue& steps) {
  ServoOptions options;
  options.steps = &steps;
  return options;
}

}  // namespace

PacedServo::PacedServo(Scene& scene, const Trajectory& hand, WaitingClock& clock)
    : clock_(clock),
      script_(hand),
      paced_(script_, clock),
      device_(paced_),
      steps_(kMostWaiting),
      servo_(device_, scene, noted_by(steps_)) {}

ServoRun PacedServo::run(std::optional<int> processor) {
  ServoRun result;
  {
    const ServoThread thread(servo_, clock_, {.processor = processor}, kServoRate);
    result.realtime = thread.realtime();
    while (thread.running()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      while (const std::optional<ServoState> state = steps_.pop()) {
        result.touching += state->contact.touching ? 1 : 0;
        result.computing.push_back(state->timing.computing);
      }
    }
    result.skipped = thread.skipped();
  }
  std::ranges::sort(result.computing);
  result.lateness = servo_.durations().lateness;
  result.steps = servo_.state().step;
  result.faults = servo_.state().guard.counts.faults;
  result.lock_waits = device_.other_waits();
  return result;
}

std::string in_words(const ServoRun& run) {
  const Durations& late = run.lateness;
  return fmt::format(
      "{} steps, {:.0f} % touching, {} left out; late p50 {:.3f} ms, p99 {:.3f} ms, max {:.1f} "
      "ms; computing p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us; faults {}; waits for a lock: {}",
      run.steps, 100.0 * static_cast<double>(run.touching) / static_cast<double>(run.steps),
      run.skipped, 1e3 * late.quantile(0.5), 1e3 * late.quantile(0.99), 1e3 * late.longest,
      1e6 * quantile(run.computing, 0.5), 1e6 * quantile(run.computing, 0.99),
      1e6 * quantile(run.computing, 1), run.faults, run.lock_waits);
}

Trajectory hand_over(const Scene& scene, double seconds) {
  const auto points = scene.source(0).points();
  StrokeOptions options;
  options.duration = seconds;
  options.radius = points->radius;
  options.depth = kDepth;
  options.region = kRegion;
  return explore({points->origin, points->grid.points(), points->normals}, options);
}

}  // namespace palpate::servo_cost
