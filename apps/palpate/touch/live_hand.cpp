#include "apps/palpate/touch/live_hand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace palpate::app {

namespace {

constexpr double kQueue = 4;  // s of steps that writing them down may fall behind

// A trajectory may have few rows or many; the clock has its own.
double rate_of(const Hand& hand) {
  return std::clamp(hand.device->info().rate, ServoThread::kLeastRate, ServoThread::kMostRate);
}

Device& paced_by(std::optional<PacedDevice>& paced, Device& device, const Clock& clock) {
  if (!device.info().keeps_time) return device;
  return paced.emplace(device, clock);
}

ServoOptions servo_options(const Run& run, const Hand& hand, StepQueue& steps) {
  ServoOptions options;
  options.field = run.field;
  options.proxy = run.proxy;
  options.guard = guard_options(run.options.live);
  options.workspace = hand.workspace;
  options.clutch_button = hand.clutch;
  options.steps = &steps;
  return options;
}

// With the force that was felt, which the guard may have changed.
TouchStep step_of(const ServoState& state, const DeviceInfo& device, double start) {
  TouchStep step;
  step.time = state.time - start;
  step.hip = state.hip;
  step.shift = state.shift;
  step.contact = state.contact;
  step.contact.force = state.force;
  step.microseconds = 1e6 * state.timing.computing;
  step.patch_points = state.patch_points;
  step.notes = state.field_notes;
  if (device.has_orientation) step.orientation = state.orientation;
  if (device.has_gripper) step.gripper = state.gripper;
  return step;
}

}  // namespace

LiveHand::LiveHand(Run& run, std::size_t index, WaitingClock& clock)
    : hand_(run.hands[index]),
      index_(index),
      rate_(rate_of(hand_)),
      steps_(static_cast<std::size_t>(kQueue * rate_)),
      servo_(paced_by(paced_, *hand_.device, clock), run.felt, servo_options(run, hand_, steps_)),
      thread_(servo_, clock, {.rate = rate_, .realtime = realtime_options(run.options.live)}) {}

void LiveHand::begin(double start) {
  start_ = start;
  looked_ = start;
}

void LiveHand::take_steps(const EachStep& each) {
  while (const std::optional<ServoState> state = steps_.pop()) {
    if (state->time < start_) continue;
    const TouchStep step = step_of(*state, hand_.device->info(), start_);
    force_ = std::max(force_, step.contact.force.norm());
    each(index_, step);
  }
}

bool LiveHand::over(double now) const {
  return !thread_.running() || (hand_.duration && now - start_ >= *hand_.duration);
}

std::string LiveHand::failure() const {
  if (thread_.running() || servo_.state().device != DeviceStatus::failed) return {};
  return fmt::format("{}: device '{}' failed: {}", hand_.name, hand_.device->info().name,
                     hand_.device->reason());
}

HandMoment LiveHand::moment(double now) {
  HandMoment moment;
  moment.name = hand_.name;
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
  if (moment.servo.device == DeviceStatus::silent) moment.silence = hand_.device->reason();
  moment.ended = !thread_.running();
  return moment;
}

LiveReport LiveHand::report() const {
  LiveReport report;
  report.realtime = thread_.realtime();
  report.rate = rate_;
  report.lateness = servo_.lateness();
  report.skipped = thread_.skipped();
  report.unwritten = steps_.dropped();
  report.limits = servo_.options().guard;
  report.guard = servo_.state().guard;
  report.failure = failure();
  return report;
}

}  // namespace palpate::app
