#include "apps/palpate/touch/touch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/cli/temporary_folder.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/report/touch_report.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/run/view_settings.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {
namespace {

std::vector<SimulatedStream> make_streams(Run& run) {
  SimulatedStreamOptions options;
  options.latency = run.time.latency.value_or(options.latency);
  std::vector<SimulatedStream> streams;
  for (std::size_t i = 0; i < run.loaded.sources.size(); ++i) {
    LoadedSource& from = run.loaded.sources[i];
    if (!from.camera) continue;
    from.feed.simulated = true;
    Feeding feed = feeding(run.loaded, i, run.recorder);
    streams.emplace_back(*from.camera, run.loaded.scene.source(i).name(), std::move(feed.sink),
                         options, std::move(feed.ended));
  }
  return streams;
}

}  // namespace

bool run_simulated(Run& run, const EachStep& each) {
  const Hand& hand = run.hands.front();
  Device& device = *hand.device;
  ServoOptions options = servo_options(run, hand);
  options.guard.on = false;
  Servo servo(device, run.loaded.scene, options);
  if (run.recorder != nullptr) run.recorder->begin(run.loaded, {&servo}, 0, true);
  std::vector<SimulatedStream> streams = make_streams(run);
  const Interruption interruption;
  DeviceState state = device.read();
  for (; state.status != DeviceState::Status::finished; state = device.read()) {
    if (state.status == DeviceState::Status::failed) {
      throw Error(fmt::format("device '{}' failed: {}", device.info().name, device.reason()));
    }
    for (SimulatedStream& stream : streams) stream.advance(state.time);
    if (interruption.asked()) break;
    const double start = thread_cpu_seconds();
    const ServoState& step = servo.step(state, state.time);
    const double computing = thread_cpu_seconds() - start;
    device.write(servo.device_force());
    servo.show({.computing = computing});
    if (run.recorder != nullptr) run.recorder->keep_up();
    each(0, step);
  }
  std::vector<StreamState> states;
  for (const SimulatedStream& stream : streams) states.push_back(stream.state());
  keep_states(run.loaded, states);
  return !interruption.asked();
}

namespace {

// Every file is made before the work: a place that does not exist is told at once.
struct TouchOutputs {
  std::deque<HandOutputs> hands;
  std::vector<std::string> unlogged;  // of each hand: why its log is not whole
  std::optional<OutputFile> json;
  std::optional<Recorder> recorder;
  std::optional<Unguarded> unguarded;  // of a run in simulated time

  explicit TouchOutputs(const TouchPlan& plan) {
    const OutputPlan& files = plan.outputs;
    for (std::size_t i = 0; i < plan.devices.size(); ++i) hands.emplace_back(files, i);
    if (!files.json.empty()) json.emplace(files.json);
    if (!files.record.empty() || plan.page.served) recorder.emplace(files.record);
  }
};

bool play_simulated(Run& run, TouchOutputs& outputs) {
  const Hand& hand = run.hands.front();
  Unguarded& unguarded =
      outputs.unguarded.emplace(run.time.guard, hand.device->info(), hand.workspace.scale);
  HandOutputs& kept = outputs.hands.front();
  Progress progress("touching");
  const auto whole = static_cast<double>(hand.steps);
  return run_simulated(run, [&](std::size_t, const ServoState& step) {
    kept.add(step, hand.device->info());
    unguarded.add(step);
    const std::size_t steps = kept.statistics().steps();
    if (steps % 256 == 0) progress.update(static_cast<double>(steps) / whole);
  });
}

// Runs, in the time of `clock` if there is one, and hands each step to what keeps or sums it. In
// simulated time there are no reports of real time.
LiveOutcome play(Run& run, WaitingClock* clock, TouchOutputs& outputs) {
  LiveOutcome outcome;
  if (clock == nullptr) {
    outcome.interrupted = !play_simulated(run, outputs);
  } else {
    outcome = run_live(run, *clock, [&](std::size_t hand, const ServoState& step) {
      outputs.hands[hand].add(step, run.hands[hand].device->info());
    });
  }
  for (HandOutputs& hand : outputs.hands) outputs.unlogged.push_back(hand.close_log());
  return outcome;
}

// Cameras and preparation, whose threads are started later, stay off the servo's processor.
std::optional<RealtimeReport::Request> leave_to_servo(const TimePlan& time) {
  if (!time.real_time || !time.realtime.processor) return {};
  return leave_processor(*time.realtime.processor);
}

// A texture that is carved deeper than the thinnest surface reaches no hand could meet.
void check_texture(double amplitude, const Scene& scene) {
  const double largest = deepest_texture(scene);
  if (amplitude <= largest) return;
  throw UsageError(
      fmt::format("--texture-amplitude {} is too deep for the surface's R; give at most {:.2g}",
                  amplitude, largest));
}

bool has_surface(const LoadedScene& loaded) {
  bool found = false;  // a camera may show one at any time
  for (std::size_t i = 0; i < loaded.sources.size() && !found; ++i) {
    found = loaded.sources[i].camera || !on_a_line(loaded.scene.source(i).points()->grid.points());
  }
  return found;
}

std::vector<HandReport> hand_reports(const Run& run, const TouchOutputs& outputs,
                                     const LiveOutcome& outcome) {
  const bool scales = std::ranges::any_of(
      run.loaded.sources, [](const LoadedSource& source) { return !source.camera; });
  std::vector<HandReport> reports;
  for (std::size_t i = 0; i < run.hands.size(); ++i) {
    reports.push_back({run.hands[i], outputs.hands[i].statistics(), run.field, run.proxy.stiffness,
                       outcome.hands.empty() ? nullptr : &outcome.hands[i],
                       outputs.unguarded ? &*outputs.unguarded : nullptr, outcome.interrupted,
                       scales, has_surface(run.loaded), outputs.unlogged[i]});
  }
  return reports;
}

bool felt_nothing(const HandReport& report) {
  const TouchStatistics& s = report.statistics;
  return s.steps() > 0 && s.faults() == s.steps();
}

// Everything was written by then.
void check_hands(const std::vector<HandReport>& hands) {
  for (const HandReport& hand : hands) {
    if (hand.live != nullptr && !hand.live->failure.empty()) throw Error(hand.live->failure);
    if (!hand.unlogged.empty()) throw Error(hand.unlogged);
  }
  if (std::ranges::none_of(hands, felt_nothing)) return;
  throw Error(
      "every step was a fault, so no force was rendered (all outputs were written); check the "
      "trajectory and --pose");
}

// The pictures come last: everything else is there if they cannot be drawn.
void tell(const TouchReport& report, std::FILE* stream, TouchOutputs& outputs) {
  const Json data = report_on(report, stream);
  write_whole(outputs.json, text_of(data));
  for (std::size_t i = 0; i < report.hands.size(); ++i) {
    outputs.hands[i].draw(report.loaded.scene, title_of(report.loaded), report.hands[i]);
  }
  check_hands(report.hands);
  for (const RecordReport& each : report.recorded) {
    if (!each.problem.empty()) throw Error(each.problem);
  }
}

}  // namespace

namespace {

// A run from its options to its first step: each thing is made in its turn.
struct Start {
  // `files`: where the plan's sources are, if they were sent to the program.
  Start(TouchPlan chosen, WaitingClock* clock, std::unique_ptr<TemporaryFolder> files = nullptr)
      : folder(std::move(files)),
        plan(std::move(chosen)),
        trajectory(trajectory_of(plan.motion, plan.devices)),
        outputs(plan),
        hands(open_hands(plan.devices, plan.motion, plan.time, clock)),
        left(leave_to_servo(plan.time)),
        loaded(load_sources(plan.sources, {is_explored(), outputs.recorder.has_value(), clock})) {
    check_texture(plan.surface.proxy.texture.amplitude, loaded.scene);
    place_hands(hands, {plan.motion, plan.surface, plan.page}, trajectory, loaded.scene);
    begin_run(loaded, plan.surface.soft_material(hands.front().stiffness));
  }

  [[nodiscard]] bool is_explored() const {
    const double texture = plan.surface.proxy.texture.amplitude;
    return trajectory.empty() || hands.size() > 1 || texture > 0;
  }

  std::unique_ptr<TemporaryFolder> folder;
  TouchPlan plan;
  Trajectory trajectory;
  TouchOutputs outputs;
  std::vector<Hand> hands;
  std::optional<RealtimeReport::Request> left;
  LoadedScene loaded;
};

// What comes after a run of `plan`: of a file that a page sent.
std::unique_ptr<Start> opened(const TouchPlan& plan, const std::string& name, std::string bytes,
                              WaitingClock* clock) {
  auto folder = std::make_unique<TemporaryFolder>();
  const std::string place = folder->file("");
  const std::string file = folder->write(name, std::exchange(bytes, {}));
  try {
    return std::make_unique<Start>(plan_of_file(plan, file), clock, std::move(folder));
  } catch (const std::exception& error) {  // a person knows the file by its name
    std::string problem = error.what();
    if (problem.starts_with(place)) problem.erase(0, place.size());
    throw Error(problem);
  }
}

// Runs and reports. Where a page opened a file meanwhile, what comes next.
std::unique_ptr<Start> run_and_tell(Start& start, WaitingClock* clock) {
  const TouchPlan& plan = start.plan;
  TouchOutputs& outputs = start.outputs;
  Run run{plan.time,
          plan.page,
          plan.ros,
          start.loaded,
          start.hands,
          plan.surface.field,
          plan.surface.proxy_of(start.hands.front().stiffness),
          outputs.recorder ? &*outputs.recorder : nullptr};
  std::unique_ptr<Start> next;
  if (can_open_files(plan)) {
    run.open = [&](const std::string& name, std::string bytes) {
      next = opened(plan, name, std::move(bytes), clock);
    };
  }
  LiveOutcome outcome = play(run, clock, outputs);
  for (LiveReport& each : outcome.hands) {
    if (start.left) each.realtime.requests.push_back(*start.left);
  }
  std::vector<RecordReport> recorded;
  if (outputs.recorder) recorded = outputs.recorder->finish();
  tell({start.loaded, plan.surface.paper, plan.surface.field, run.proxy,
        hand_reports(run, outputs, outcome), outcome.robot, recorded},
       plan.outputs.takes_stdout() ? stderr : stdout, outputs);
  if (!outcome.next_page) return nullptr;
  next->plan.page = *outcome.next_page;
  return next;
}

}  // namespace

void touch(const TouchPlan& plan) {
  use_range(plan.ros.range);
  SteadyClock steady;
  WaitingClock* clock = plan.time.real_time ? &steady : nullptr;
  auto start = std::make_unique<Start>(plan, clock);
  while (start) start = run_and_tell(*start, clock);
}

}  // namespace palpate::app
