#include "apps/palpate/touch_command.hpp"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/palpate/log.hpp"
#include "apps/palpate/output.hpp"
#include "apps/palpate/picture.hpp"
#include "apps/palpate/progress.hpp"
#include "apps/palpate/touch_report.hpp"
#include "apps/palpate/touch_run.hpp"
#include "apps/palpate/touch_surface.hpp"
#include "apps/palpate/touch_usage.hpp"
#include "apps/palpate/words.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/scripted.hpp"
#include "palpate/device/simulated.hpp"
#include "palpate/io/trajectory.hpp"

namespace palpate::app {

namespace {

// What moves the hand: a device, where it stands, and the surface's stiffness that goes with it.
struct Hand {
  std::unique_ptr<Device> device;
  Workspace workspace;
  double stiffness = kStiffness;

  std::size_t steps = 0;
  std::optional<ExplorationPlan> plan;
};

// The hand is where `way` says, whatever the force.
void play_back(Hand& hand, Trajectory way) {
  hand.steps = way.size();
  hand.device = std::make_unique<ScriptedDevice>(std::move(way));
}

Hand scripted(const TouchOptions& options, Trajectory trajectory) {
  Hand hand;
  hand.stiffness = options.stiffness.value_or(kStiffness);
  play_back(hand, std::move(trajectory));
  return hand;
}

// The hand is pulled along `target`, whose times begin at 0.
void simulate(Hand& hand, Trajectory target) {
  const SimulatedDeviceOptions options;
  hand.steps = static_cast<std::size_t>(target.back().time * options.rate) + 2;
  hand.device = std::make_unique<SimulatedDevice>(options, std::move(target));
}

Hand simulated(const TouchOptions& options, Trajectory trajectory) {
  Hand hand;
  hand.stiffness = options.stiffness.value_or(kStiffness);
  const double start = trajectory.front().time;
  for (TrajectoryRow& row : trajectory) row.time -= start;
  // Encoders count from where the hand begins, so that far from the origin nothing is lost.
  hand.workspace.T_world_device.translation() = trajectory.front().position;
  for (TrajectoryRow& row : trajectory) {
    row.position = hand.workspace.position_to_device(row.position);
  }
  simulate(hand, std::move(trajectory));
  return hand;
}

Hand exploring(const TouchOptions& options, const Scene& scene, const FieldOptions& field) {
  Hand hand;
  PlanOptions plan;
  plan.duration = options.duration.value_or(plan.duration);
  plan.stiffness = options.stiffness.value_or(0);
  plan.tool_radius = options.tool_radius;
  plan.seed = options.seed.value_or(plan.seed);
  const bool pulled = options.device != "scripted";
  if (!pulled) plan.hand.stiffness = std::numeric_limits<double>::infinity();
  hand.plan = plan_exploration(scene, field, plan);
  hand.workspace = hand.plan->workspace;
  hand.stiffness = hand.plan->stiffness;
  if (pulled) {
    simulate(hand, hand.plan->target);
  } else {
    play_back(hand, hand.plan->target);
  }
  return hand;
}

std::string title(const TouchReport& report) {
  std::string text;
  for (const TouchedCloud& cloud : report.clouds) {
    text += fmt::format("{}{}", text.empty() ? "" : " + ", cloud.argument.name);
  }
  return text;
}

std::string subtitle(const TouchReport& report) {
  const TouchStatistics& s = report.statistics;
  return fmt::format(
      "{} field, K = {:.4g} N/m, {} steps in {:.3g} s, {} contacts, energy given to the "
      "hand {}",
      name_of(report.field.kind), report.proxy.stiffness, grouped(s.steps()), s.duration(),
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

// Steps the run and hands each step to what keeps or sums it.
void play(Hand& hand, SceneField& field, Proxy& proxy, TouchStatistics& statistics,
          Outputs& outputs) {
  Progress progress("touching");
  run_touch(*hand.device, hand.workspace, field, proxy, [&](const TouchStep& step) {
    statistics.add(step);
    if (outputs.log) outputs.log->add(step);
    if (outputs.picture) outputs.picture->add(step);
    if (statistics.steps() % 256 == 0) {
      progress.update(static_cast<double>(statistics.steps()) / static_cast<double>(hand.steps));
    }
  });
  if (outputs.log) outputs.log->close();
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
  if (outputs.picture) outputs.picture->draw(report.scene, title(report), subtitle(report));
  const TouchStatistics& s = report.statistics;
  if (s.steps() == 0 || s.faults() < s.steps()) return;
  throw Error("every step was a fault: nothing was felt (everything was written)");
}

Hand make_hand(const TouchOptions& options, const Scene& scene, const FieldOptions& field,
               Trajectory trajectory) {
  if (trajectory.empty()) return exploring(options, scene, field);
  if (options.device == "simulated") return simulated(options, std::move(trajectory));
  return scripted(options, std::move(trajectory));
}

}  // namespace

void touch(const TouchOptions& options) {
  check_usage(options);
  Trajectory trajectory;
  if (!options.trajectory.empty()) trajectory = read_trajectory(options.trajectory);
  check_trajectory(options, trajectory);
  Outputs outputs(options);
  Scene scene;
  const std::vector<TouchedCloud> clouds = fill(scene, options);
  check_texture(options, scene);
  const FieldOptions field_choice = field_options(options);
  Hand hand = make_hand(options, scene, field_choice, std::move(trajectory));
  Scene felt;
  fill_softened(felt, scene, soft_material(options, hand.stiffness));
  SceneField field(felt, field_choice);
  Proxy proxy(proxy_options(options, hand.stiffness));
  TouchStatistics statistics(hand.steps);
  play(hand, field, proxy, statistics, outputs);
  const ExplorationPlan* plan = hand.plan ? &*hand.plan : nullptr;
  tell({scene, clouds, options, statistics, field_choice, proxy.options(), hand.device->info().name,
        plan},
       outputs);
}

}  // namespace palpate::app
