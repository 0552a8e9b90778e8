// The command touch: plans a run, runs it, reports.
#include "apps/palpate/touch/touch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/process.hpp"
#include "apps/palpate/cli/temporary_folder.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/record/recorder.hpp"
#include "apps/palpate/report/touch_report.hpp"
#include "apps/palpate/run/opening.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/view/view.hpp"
#include "palpate/base/clock.hpp"
#include "palpate/base/error.hpp"
#include "palpate/sensor/stream.hpp"
#include "palpate/servo/servo.hpp"
#include "palpate/servo/servo_thread.hpp"
#include "session/view_settings.hpp"

namespace palpate::app {
namespace {

// Every file is made before the work: a path that does not exist is reported at once.
struct TouchOutputs {
  std::deque<HandOutputs> hands;
  std::vector<std::string> unlogged;  // of each hand: why its log is not whole
  std::optional<OutputFile> json;
  std::optional<Recorder> recorder;
  std::optional<Unguarded> unguarded;  // of a run in simulated time
  std::optional<MeasuredForces> measured;

  TouchOutputs(const TouchPlan& plan, const Trajectory& trajectory) {
    if (plan.motion.reading.forces) measured.emplace(plan.motion.trajectory, trajectory);
    const OutputPlan& files = plan.outputs;
    for (std::size_t i = 0; i < plan.devices.size(); ++i)
      hands.emplace_back(files, i, plan.tool.turns());
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
    kept.add(step, hand);
    unguarded.add(step);
    if (outputs.measured) outputs.measured->add(step);
    const std::size_t steps = kept.statistics().steps();
    if (steps % 256 == 0) progress.update(static_cast<double>(steps) / whole);
  });
}

// Runs, in the time of `clock` if there is one, and hands each step to what keeps or sums it. In
// simulated time there are no reports of real time.
LiveOutcome play(Run& run, WaitingClock* clock, const Interruption* interruption,
                 TouchOutputs& outputs) {
  LiveOutcome outcome;
  if (clock == nullptr) {
    outcome.interrupted = !play_simulated(run, outputs);
  } else {
    outcome = run_live(run, *clock, *interruption, [&](std::size_t hand, const ServoState& step) {
      outputs.hands[hand].add(step, run.hands[hand]);
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
  const double largest = session::deepest_texture(scene);
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
                       scales, has_surface(run.loaded), outputs.unlogged[i],
                       outputs.measured ? &*outputs.measured : nullptr});
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
void write_report(const TouchReport& report, std::FILE* stream, TouchOutputs& outputs) {
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

// A run from its options to its first step: each thing is made in its turn.
struct Start {
  Start(TouchPlan chosen, WaitingClock* clock)
      : plan(std::move(chosen)),
        trajectory(trajectory_of(plan.motion, plan.devices)),
        tool(plan.tool.turns() ? std::optional<NamedTool>(plan.tool) : std::nullopt),
        outputs(plan, trajectory),
        hands(open_hands(plan.devices, plan.motion, plan.time, clock)),
        left(leave_to_servo(plan.time)),
        loaded(load_sources(plan.sources,
                            {.explored = is_explored(),
                             .keep_clouds = outputs.recorder.has_value(),
                             .recorded = !plan.outputs.record.empty(),
                             .on_demand = clock != nullptr && plan.outputs.record.empty(),
                             .clock = clock})) {
    check_texture(plan.surface.proxy.texture.amplitude, loaded.scene);
    place_hands(hands, {plan.motion, plan.surface, plan.page, tool ? &*tool : nullptr}, trajectory,
                loaded.scene);
    if (plan.ros.bridge.robot && tool) plan.ros.bridge.robot->shape = tool->looked_at();
    begin_run(loaded, plan.surface.soft_material(hands.front().stiffness));
  }

  [[nodiscard]] bool is_explored() const {
    const double texture = plan.surface.proxy.texture.amplitude;
    return trajectory.empty() || hands.size() > 1 || texture > 0;
  }

  TouchPlan plan;
  Trajectory trajectory;
  std::optional<NamedTool> tool;
  TouchOutputs outputs;
  std::vector<Hand> hands;
  std::optional<RealtimeReport::Request> left;
  LoadedScene loaded;
  std::shared_ptr<TemporaryFolder> folder;  // of a file that a page sent, for as long as it is felt
};

// Without the folder that a file was put into: a person recognises it by its name.
std::string without_folder(std::string text, const std::shared_ptr<TemporaryFolder>& folder) {
  if (!folder) return text;
  const std::string path = folder->file("");
  for (std::size_t at = 0; (at = text.find(path)) != std::string::npos;) {
    text.erase(at, path.size());
  }
  return text;
}

// The plan of what a page wants after a run of `plan`. `folder`: where that run's file is; becomes
// that of the next one's.
TouchPlan plan_of(const TouchPlan& plan, Opening::Wanted& wanted,
                  std::shared_ptr<TemporaryFolder>& folder) {
  if (const auto* unit = std::get_if<Opening::OtherUnit>(&wanted.what)) {
    return plan_in_unit(plan, unit->source, unit->metres);
  }
  folder.reset();
  if (const auto* named = std::get_if<Opening::Sources>(&wanted.what)) {
    return plan_of_sources(plan, named->sources);
  }
  folder = std::make_shared<TemporaryFolder>();
  std::string& bytes = std::get<Opening::Bytes>(wanted.what).bytes;
  return plan_of_file(plan, folder->lend(wanted.name, std::exchange(bytes, {})));
}

std::unique_ptr<Start> opened(const Start& before, Opening::Wanted wanted, WaitingClock* clock,
                              const Opening::Notify& notify) {
  std::shared_ptr<TemporaryFolder> folder = before.folder;
  try {
    TouchPlan next = plan_of(before.plan, wanted, folder);
    for (SourcePlan& source : next.sources) source.reading.progress = notify;
    auto start = std::make_unique<Start>(std::move(next), clock);
    start->folder = folder;
    for (LoadedSource& source : start->loaded.sources) {
      std::string& path = source.plan.argument.path;
      path = without_folder(path, folder);
    }
    return start;
  } catch (const std::bad_alloc&) {
    throw Error(wanted.name + " is too large for the memory that is left");
  } catch (const std::exception& error) {
    throw Error(without_folder(error.what(), folder));
  }
}

// Runs, and reports on all that came of it. Where a page opened a file meanwhile: what comes next.
// @throws Error when something failed, after `next` was set.
void run_and_report(Start& start, WaitingClock* clock, std::optional<Interruption>& interruption,
                    std::unique_ptr<Start>& next) {
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
  std::unique_ptr<Start> prepared;
  Opening opening([&](Opening::Wanted wanted, const Opening::Notify& notify) {
    prepared = opened(start, std::move(wanted), clock, notify);
  });
  if (can_open_files(plan)) run.opening = &opening;
  LiveOutcome outcome = play(run, clock, interruption ? &*interruption : nullptr, outputs);
  if (outcome.next_page) {
    next = std::move(prepared);
    next->plan.page = *outcome.next_page;
  }
  for (LiveReport& each : outcome.hands) {
    if (start.left) each.realtime.requests.push_back(*start.left);
  }
  std::vector<RecordReport> recorded;
  if (outputs.recorder) recorded = outputs.recorder->finish();
  write_report({start.loaded, plan.surface.paper, plan.surface.field, run.proxy,
                hand_reports(run, outputs, outcome), outcome.robot, recorded},
               plan.outputs.takes_stdout() ? stderr : stdout, outputs);
  if (!next) interruption.reset();  // all is reported: nothing waits for what is being opened
}

}  // namespace

void touch(const TouchPlan& plan) {
  use_range(plan.ros.range);
  SteadyClock steady;
  WaitingClock* clock = plan.time.real_time ? &steady : nullptr;
  WaitingPage page(plan);
  auto start = std::make_unique<Start>(page.watching(plan), clock);
  start->plan.page = page.end();
  std::optional<Interruption> interruption;  // of all runs
  if (clock != nullptr) interruption.emplace();
  bool failed = false;
  while (start && !(interruption && interruption->requested())) {
    std::unique_ptr<Start> next;
    try {
      run_and_report(*start, clock, interruption, next);
    } catch (const Error& error) {
      if (!next) throw;
      fmt::print(stderr, "{}\n", without_controls(error.what()));
      failed = true;
    }
    start = std::move(next);
  }
  if (failed) throw Error("an earlier run failed; what it said is above");
}

}  // namespace palpate::app
