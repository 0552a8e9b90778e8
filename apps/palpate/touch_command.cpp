#include "apps/palpate/touch_command.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "apps/palpate/live_run.hpp"
#include "apps/palpate/log.hpp"
#include "apps/palpate/names.hpp"
#include "apps/palpate/output.hpp"
#include "apps/palpate/picture.hpp"
#include "apps/palpate/progress.hpp"
#include "apps/palpate/run.hpp"
#include "apps/palpate/touch_report.hpp"
#include "apps/palpate/touch_surface.hpp"
#include "apps/palpate/touch_usage.hpp"
#include "apps/palpate/words.hpp"
#include "palpate/base/error.hpp"
#include "palpate/servo/realtime.hpp"

namespace palpate::app {

namespace {

std::string subtitle(const TouchReport& report) {
  const TouchStatistics& s = report.statistics;
  return fmt::format(
      "{} field, K = {:.4g} N/m, {} steps in {:.3g} s, {} contacts, energy given to the "
      "hand {}",
      name_in(kFields, report.field.kind), report.proxy.stiffness, grouped(s.steps()), s.duration(),
      grouped(s.contacts()), energy(energy_at_hand(report).given));
}

// Every file is made before the work: a place that does not exist is told at once.
struct Outputs {
  std::optional<TouchLog> log;
  std::optional<OutputFile> json;
  std::optional<Picture> picture;

  explicit Outputs(const TouchOptions& options) {
    if (!options.log.empty()) log.emplace(options.log);
    if (!options.json.empty()) json.emplace(options.json);
    if (options.picture.empty()) return;
    picture.emplace(options.picture);
  }
};

// How a run went.
struct Played {
  std::optional<LiveReport> live;  // in real time
  bool interrupted = false;
};

bool play_simulated(Run& run, const TouchStatistics& statistics, const EachStep& keep) {
  Progress progress("touching");
  return run_simulated(run, [&](const TouchStep& step) {
    keep(step);
    if (statistics.steps() % 256 == 0) {
      progress.update(static_cast<double>(statistics.steps()) /
                      static_cast<double>(run.hand.steps));
    }
  });
}

// Runs, in the time of `clock` if there is one, and hands each step to what keeps or sums it.
Played play(Run& run, WaitingClock* clock, TouchStatistics& statistics, Outputs& outputs) {
  const EachStep keep = [&](const TouchStep& step) {
    statistics.add(step);
    if (outputs.log) outputs.log->add(step);
    if (outputs.picture) outputs.picture->add(step);
  };
  Played played;
  if (clock == nullptr) {
    played.interrupted = !play_simulated(run, statistics, keep);
  } else {
    played.live = run_live(run, *clock, keep);
    played.interrupted = played.live->interrupted;
  }
  if (outputs.log) outputs.log->close();
  return played;
}

// Cameras and preparation, whose threads are started later, stay off the servo's processor.
std::optional<RealtimeRequest> leave_to_servo(const TouchOptions& options, bool real_time) {
  if (!real_time || !options.live.processor) return {};
  return leave_processor(*options.live.processor);
}

// The picture comes last: everything else is there if it cannot be drawn.
void tell(const TouchReport& report, Outputs& outputs) {
  const TouchOptions& options = report.options;
  const bool stdout_taken = options.log == "-" || options.json == "-";
  print_report(report, stdout_taken ? stderr : stdout);
  if (outputs.json) {
    outputs.json->write(json_report(report).dump(2));
    outputs.json->write("\n");
    outputs.json->close();
  }
  if (outputs.picture) {
    outputs.picture->draw(report.felt, title_of(report.touched), subtitle(report));
  }
  const TouchStatistics& s = report.statistics;
  if (s.steps() == 0 || s.faults() < s.steps()) return;
  throw Error("every step was a fault: nothing was felt (everything was written)");
}

}  // namespace

void touch(const TouchOptions& options) {
  check_usage(options);
  Trajectory way = read_way(options);
  Outputs outputs(options);
  const bool explored = way.empty() || options.texture_amplitude > 0;
  SteadyWaitingClock steady;
  WaitingClock* clock = in_real_time(options) ? &steady : nullptr;
  const std::optional<RealtimeRequest> left = leave_to_servo(options, clock != nullptr);
  Touched touched = prepare_touched(options, explored, clock);
  check_texture(options, touched.scene);
  const FieldOptions field = field_options(options);
  Hand hand = make_hand(options, std::move(way), touched.scene, field);
  Scene felt;
  fill_felt(felt, touched, soft_material(options, hand.stiffness));
  Run run{options, touched, felt, hand, field, proxy_options(options, hand.stiffness)};
  TouchStatistics statistics;
  Played played = play(run, clock, statistics, outputs);
  LiveReport* const live = played.live ? &*played.live : nullptr;
  if (live != nullptr && left) live->realtime.requests.push_back(*left);
  tell({touched, felt, options, statistics, field, run.proxy, hand.device->info().name,
        hand.plan ? &*hand.plan : nullptr, live, played.interrupted},
       outputs);
}

}  // namespace palpate::app
