#include "apps/palpate/live_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "apps/palpate/interruption.hpp"
#include "apps/palpate/live_feed.hpp"
#include "apps/palpate/live_status.hpp"
#include "apps/palpate/view.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/paced.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {

namespace {

constexpr double kQueue = 4;  // s of steps that writing them down may fall behind
constexpr std::chrono::milliseconds kLook{20};

// A trajectory may have few rows or many; the clock has its own.
double rate_of(const Run& run) {
  return std::clamp(run.hand.device->info().rate, ServoThread::kLeastRate, ServoThread::kMostRate);
}

ServoOptions servo_options(const Run& run, StepQueue& steps) {
  ServoOptions options;
  options.field = run.field;
  options.proxy = run.proxy;
  options.guard = guard_options(run.options.live);
  options.workspace = run.hand.workspace;
  options.steps = &steps;
  return options;
}

ServoThreadOptions thread_options(const Run& run, double rate) {
  return {.rate = rate, .realtime = realtime_options(run.options.live)};
}

// With the force that was felt, which the guard may have changed. The first may come a little
// before the start.
TouchStep step_of(const ServoState& state, double start) {
  TouchStep step;
  step.time = std::max(0.0, state.time - start);
  step.hip = state.hip;
  step.contact = state.contact;
  step.contact.force = state.force;
  step.microseconds = 1e6 * state.timing.computing;
  step.patch_points = state.patch_points;
  step.notes = state.field_notes;
  return step;
}

// Takes steps from the servo to whoever wants each, and sums up what the status tells.
class Watcher {
 public:
  Watcher(const Servo& servo, StepQueue& steps, EachStep each, double start)
      : servo_(servo), steps_(steps), each_(std::move(each)), start_(start) {}

  void take_steps() {
    while (const std::optional<ServoState> state = steps_.pop()) {
      const TouchStep step = step_of(*state, start_);
      force_ = std::max(force_, step.contact.force.norm());
      each_(step);
    }
  }

  LiveMoment moment(double now, const LiveFeed& feed) {
    LiveMoment moment;
    moment.time = now - start_;
    moment.servo = servo_.state();
    moment.force = std::exchange(force_, 0);
    const Durations lateness = servo_.lateness();
    const Durations computing = servo_.computing();
    moment.lateness = lateness.since(lateness_);
    moment.computing = computing.since(computing_);
    const double span = now - std::exchange(looked_, now);
    moment.rate = span > 0 ? static_cast<double>(moment.computing.count) / span : 0;
    lateness_ = lateness;
    computing_ = computing;
    moment.streams = feed.states();
    return moment;
  }

 private:
  const Servo& servo_;
  StepQueue& steps_;
  EachStep each_;
  double start_;
  double looked_ = start_;
  double force_ = 0;
  Durations lateness_;
  Durations computing_;
};

void check_device(const Run& run, const ServoState& last) {
  if (last.device != DeviceStatus::failed) return;
  const Device& device = *run.hand.device;
  throw Error(fmt::format("device '{}' failed: {}", device.info().name, device.reason()));
}

}  // namespace

LiveReport run_live(Run& run, WaitingClock& clock, const EachStep& each) {
  LiveReport report;
  report.rate = rate_of(run);
  PacedDevice device(*run.hand.device, clock);
  StepQueue steps(static_cast<std::size_t>(kQueue * report.rate));
  Servo servo(device, run.felt, servo_options(run, steps));
  const Interruption interruption;
  LiveStatus status;
  // Setting it up may take half a second; recordings begin when the hand does.
  ServoThread thread(servo, clock, thread_options(run, report.rate));
  report.realtime = thread.realtime();
  const double start = clock.now();
  LiveFeed feed(run.touched, run.felt, clock, start);
  std::optional<View> view;
  if (is_viewed(run.options.view)) view.emplace(run, servo, feed);
  Watcher watcher(
      servo, steps,
      [&](const TouchStep& step) {
        each(step);
        if (view) view->add(step);
      },
      start);
  while (thread.running() && !interruption.asked()) {
    std::this_thread::sleep_for(kLook);
    watcher.take_steps();
    if (view) view->look();
    const double now = clock.now();
    if (status.due(now - start)) status.show(watcher.moment(now, feed));
  }
  thread.stop();
  report.skipped = thread.skipped();
  watcher.take_steps();
  feed.finish();
  report.lateness = servo.lateness();
  report.unwritten = steps.dropped();
  report.limits = servo.options().guard;
  report.guard = servo.state().guard;
  report.interrupted = interruption.asked();
  check_device(run, servo.state());
  return report;
}

}  // namespace palpate::app
