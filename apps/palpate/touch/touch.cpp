#include "apps/palpate/touch/touch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/process.hpp"
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

void touch(const TouchPlan& plan) {
  use_range(plan.ros.range);
  const Trajectory trajectory = trajectory_of(plan.motion, plan.devices);
  TouchOutputs outputs(plan);
  SteadyClock steady;
  WaitingClock* clock = plan.time.real_time ? &steady : nullptr;
  std::vector<Hand> hands = open_hands(plan.devices, plan.motion, plan.time, clock);
  const SurfacePlan& surface = plan.surface;
  const double texture = surface.proxy.texture.amplitude;
  const bool explored = trajectory.empty() || hands.size() > 1 || texture > 0;
  const std::optional<RealtimeReport::Request> left = leave_to_servo(plan.time);
  LoadedScene loaded = load_sources(plan.sources, {explored, outputs.recorder.has_value(), clock});
  check_texture(texture, loaded.scene);
  place_hands(hands, {plan.motion, surface, plan.page}, trajectory, loaded.scene);
  const double stiffness = hands.front().stiffness;
  begin_run(loaded, surface.soft_material(stiffness));
  Run run{plan.time,
          plan.page,
          plan.ros,
          loaded,
          hands,
          surface.field,
          surface.proxy_of(stiffness),
          outputs.recorder ? &*outputs.recorder : nullptr};
  LiveOutcome outcome = play(run, clock, outputs);
  for (LiveReport& each : outcome.hands) {
    if (left) each.realtime.requests.push_back(*left);
  }
  std::vector<RecordReport> recorded;
  if (outputs.recorder) recorded = outputs.recorder->finish();
  tell({loaded, surface.paper, surface.field, run.proxy, hand_reports(run, outputs, outcome),
        outcome.robot, recorded},
       plan.outputs.takes_stdout() ? stderr : stdout, outputs);
}

namespace {

struct DemoScene {
  const char* name;
  const char* description;
  std::array<const char*, 2> sources;  // null: none
};

constexpr std::array<DemoScene, 5> kScenes = {{
    {"desk",
     "a depth camera over a table-top with a wire and other objects, one of them moving",
     {"desk=camera:simulated:desk", nullptr}},
    {"arm",
     "a table-top seen by a structured-light sensor, with an arm moving back and forth over it",
     {"arm=camera:simulated:arm,noise=structured", nullptr}},
    {"scan", "a rabbit, like a laser scan", {"rabbit=synthetic:rabbit", nullptr}},
    {"two",
     "two depth cameras that see one scene from two sides, misaligned by 2 mm",
     {"left=camera:simulated:table,view=40,phase=0.011,seed=2,error=0.002",
      "right=camera:simulated:table,view=-40"}},
    {"room", "a room of 4 x 3 m, 300 000 points", {"room=synthetic:room", nullptr}},
}};

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const DemoScene& scene : kScenes) result.emplace_back(scene.name);
  return result;
}

std::string list() {
  std::string text = "scene to touch (desk):";
  for (const DemoScene& scene : kScenes) {
    text += std::string("\n") + scene.name + ": " + scene.description;
  }
  return text;
}

std::vector<std::string> sources_of(const std::string& name) {
  std::vector<std::string> sources;
  for (const DemoScene& scene : kScenes) {
    if (scene.name != name) continue;
    for (const char* source : scene.sources) {
      if (source != nullptr) sources.emplace_back(source);
    }
  }
  return sources;
}

}  // namespace

void add_demo_options(CLI::App& command, DemoOptions& o) {
  TouchPlan& plan = o.touch.plan;
  command.add_option("scene", o.scene, list())->check(one_of(names()))->type_name("SCENE");
  OptionTable table(command);
  table.under("Options");
  table.add("--duration", plan.motion.duration, "SECONDS",
            number("from 0.1 to 86400 s", [](double x) { return x >= 0.1 && x <= 86'400; }),
            "stop after this time (default: at Ctrl-C)");
  table.add_flag("--headless", o.headless, "do not open a browser");
  table.under("Hand, time and page");
  add_device_option(table, plan.devices);
  add_live_options(table, plan.time);
  add_page_options(table, plan.page);
}

void demo(const CLI::App& command, const DemoOptions& options) {
  TouchChoices choices = options.touch;
  choices.sources = sources_of(options.scene);
  choices.plan.page.wanted = true;
  choices.plan.page.open_browser = !options.headless;
  touch(plan_touch(command, choices));
}

}  // namespace palpate::app
