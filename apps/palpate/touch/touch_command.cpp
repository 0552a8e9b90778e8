#include "apps/palpate/touch/touch_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/touch_surface.hpp"
#include "apps/palpate/options/touch_usage.hpp"
#include "apps/palpate/report/hand_outputs.hpp"
#include "apps/palpate/report/touch_report.hpp"
#include "apps/palpate/run/run.hpp"
#include "apps/palpate/touch/live_run.hpp"
#include "palpate/base/error.hpp"
#include "palpate/servo/servo_thread.hpp"

namespace palpate::app {

namespace {

// Every file is made before the work: a place that does not exist is told at once.
struct TouchOutputs {
  std::deque<HandOutputs> hands;
  std::optional<OutputFile> json;
  std::optional<Unguarded> unguarded;  // of a run in simulated time

  explicit TouchOutputs(const TouchOptions& options) {
    const std::size_t count = choose_devices(options).size();
    for (std::size_t i = 0; i < count; ++i) hands.emplace_back(options, i);
    if (!options.json.empty()) json.emplace(options.json);
  }
};

bool play_simulated(Run& run, TouchOutputs& outputs) {
  const Hand& hand = run.hands.front();
  Unguarded& unguarded =
      outputs.unguarded.emplace(run.options.live, hand.device->info(), hand.workspace.scale);
  HandOutputs& kept = outputs.hands.front();
  Progress progress("touching");
  const auto whole = static_cast<double>(hand.steps);
  return run_simulated(run, [&](std::size_t, const TouchStep& step) {
    kept.add(step);
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
    outcome = run_live(run, *clock, [&](std::size_t hand, const TouchStep& step) {
      outputs.hands[hand].add(step);
    });
  }
  for (HandOutputs& hand : outputs.hands) hand.close_log();
  return outcome;
}

// Cameras and preparation, whose threads are started later, stay off the servo's processor.
std::optional<RealtimeRequest> leave_to_servo(const TouchOptions& options, bool real_time) {
  if (!real_time || !options.live.processor) return {};
  return leave_processor(*options.live.processor);
}

std::vector<HandReport> hand_reports(const Run& run, const TouchOutputs& outputs,
                                     const LiveOutcome& outcome) {
  const bool scales = std::ranges::any_of(
      run.touched.sources, [](const TouchedSource& source) { return !source.camera; });
  std::vector<HandReport> reports;
  for (std::size_t i = 0; i < run.hands.size(); ++i) {
    reports.push_back({run.hands[i], outputs.hands[i].statistics(), run.field, run.proxy.stiffness,
                       outcome.hands.empty() ? nullptr : &outcome.hands[i],
                       outputs.unguarded ? &*outputs.unguarded : nullptr, outcome.interrupted,
                       scales});
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
  }
  if (std::ranges::none_of(hands, felt_nothing)) return;
  throw Error("every step was a fault: nothing was felt (everything was written)");
}

// The pictures come last: everything else is there if they cannot be drawn.
void tell(const TouchReport& report, TouchOutputs& outputs) {
  const TouchOptions& options = report.options;
  const bool stdout_taken = options.log == "-" || options.json == "-";
  print_report(report, stdout_taken ? stderr : stdout);
  if (outputs.json) write_whole(outputs.json, json_report(report).dump(2) + "\n");
  for (std::size_t i = 0; i < report.hands.size(); ++i) {
    outputs.hands[i].draw(report.felt, title_of(report.touched), report.hands[i]);
  }
  check_hands(report.hands);
}

}  // namespace

void touch(const TouchOptions& options) {
  check_usage(options);
  const Trajectory way = read_way(options);
  TouchOutputs outputs(options);
  SteadyWaitingClock steady;
  WaitingClock* clock = in_real_time(options) ? &steady : nullptr;
  std::vector<Hand> hands = open_hands(options, clock);
  const bool explored = way.empty() || hands.size() > 1 || options.texture_amplitude > 0;
  const std::optional<RealtimeRequest> left = leave_to_servo(options, clock != nullptr);
  Touched touched = prepare_touched(options, explored, clock);
  check_texture(options, touched.scene);
  const FieldOptions field = field_options(options);
  place_hands(hands, options, way, touched.scene, field);
  const double stiffness = hands.front().stiffness;
  Scene felt;
  fill_felt(felt, touched, soft_material(options, stiffness));
  Run run{options, touched, felt, hands, field, proxy_options(options, stiffness)};
  LiveOutcome outcome = play(run, clock, outputs);
  for (LiveReport& each : outcome.hands) {
    if (left) each.realtime.requests.push_back(*left);
  }
  tell({touched, felt, options, field, run.proxy, hand_reports(run, outputs, outcome)}, outputs);
}

}  // namespace palpate::app
