// Reports on one hand of a run.
#include "apps/palpate/report/hand_report.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/report/source_report.hpp"
#include "apps/palpate/report/tool_report.hpp"
#include "field/description.hpp"

namespace palpate::app {

namespace {

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

void add_guard(Report& report, const GuardOptions& limits, const Guard::State& guard) {
  const Guard::State::Counts& n = guard.counts;
  report.row(
      "guard",
      "[at most {live/guard/maximum_force_N}|no force limit], {live/guard/slew_N_per_s}, "
      "watchdog {live/guard/watchdog_s}[; {live/guard/slewed} steps slew-limited]"
      "[; {live/guard/clamped} steps force-limited]"
      "[; {live/guard/braked} steps braked to dissipate energy given to the hand]"
      "[; {live/guard/starting} steps in a soft start]"
      "[; {live/guard/softened} steps with stiffness reduced to the device's limit]"
      "[; {live/guard/silences} watchdog stops][; {live/guard/faults} faults]"
      "[{?}; no intervention]",
      limits.maximum_force, limits.slew, limits.silence, n.slewed, n.clamped, n.braked, n.starting,
      n.softened, n.silences, n.faults,
      n.slewed + n.clamped + n.braked + n.starting + n.softened + n.silences + n.faults == 0);
  report.data["live"]["guard"].update({{"damping_Ns_per_m", limits.damping},
                                       {"soft_start_s", limits.soft_start},
                                       {"passivity", limits.passivity.on}});
  report.row({"fault", Mark::warning}, "[{?}{live/guard/fault}]", guard.fault != Guard::Fault::none,
             in_words(guard.fault));
}

// How well time was kept, what the guard did, what the system granted.
void add_live(Report& report, const LiveReport& live) {
  report.row("pace",
             "{live/rate_Hz}; late by {live/late_s/p50} (p50), {live/late_s/p99} (p99), "
             "{live/late_s/max} (max); steps skipped: [{live/steps_left_out}|none]",
             live.rate, live.lateness.quantile(0.5), live.lateness.quantile(0.99),
             live.lateness.longest, live.skipped);
  report.row({"unwritten", Mark::warning},
             "[{live/steps_unwritten} steps were not recorded because they came too fast; they are "
             "missing from the log]",
             live.unwritten);
  add_guard(report, live.limits, live.guard);
  report.data["live"]["realtime"] = Json::array();
  for (const RealtimeReport::Request& each : live.realtime.requests) {
    report.item("live/realtime", {"real time", each.granted ? Mark::plain : Mark::warning},
                "{what}: [granted{granted}|not granted: {remedy}]", each.what, each.granted,
                each.remedy);
  }
  report.row({"FAILED", Mark::error}, "[{live/failure}]", live.failure);
}

void add_unguarded(Report& report, const Unguarded& run) {
  const Guard::State::Counts& n = run.counts();
  report.row("guard",
             "none in simulated time[; it would have slew-limited {unguarded/would_slow_steps} "
             "steps (largest {unguarded/largest_slowed_step_N} in a step)]"
             "[; it would have limited {unguarded/would_shorten_steps} steps to "
             "{unguarded/maximum_force_N}][{?}; it would not have intervened]",
             n.slewed, run.largest_change(), n.clamped, run.limits().maximum_force,
             n.slewed + n.clamped == 0);
  report.data["unguarded"]["slew_N_per_s"] = run.limits().slew;
}

void add_scale(Report& report, const Hand& hand) {
  const double scale = hand.workspace.scale;
  report.row("scale",
             "[{?}1 m of hand motion is {device/scale} m in the cloud; {_N_per_m} there is "
             "{device/felt_stiffness_N_per_m} at the hand]",
             scale != 1, scale, hand.stiffness, hand.workspace.felt_stiffness(hand.stiffness));
}

// Pose of a device that a person or a program moves.
void add_placement(Report& report, const Hand& hand) {
  const Eigen::Vector3d& origin = hand.workspace.T_world_device.translation();
  const PlacementOptions& placement = hand.chosen.placement;
  report.row("origin", "{device/origin_m}, axes {}",
             std::vector{origin.x(), origin.y(), origin.z()},
             placement.frame.empty() ? "of the world" : "as " + placement.frame + " looks");
  add_scale(report, hand);
  if (!placement.frame.empty()) report.data["device"]["frame"] = placement.frame;
  if (placement.clutch) report.row("clutch", "button {device/clutch_button}", *placement.clutch);
}

void add_device(Report& report, const Hand& hand) {
  report.data["device"] = {{"name", hand.device->info().name}};
  if (hand.tool) {
    add_tool(report, *hand.tool, hand.stiffness);
    report.row("held", "[{tool/held}]", hand.held);
  }
  if (hand.plan) {
    report.row("explored",
               "an area up to {device/explored_m} across, pressing about {device/depth_m} deep",
               hand.plan->region, hand.plan->depth);
    add_scale(report, hand);
  }
  if (hand.socket != nullptr) {
    const RemoteDevice::Counts counts = hand.socket->counts();
    report.row("socket",
               "{device/socket}: {device/packets_taken} of {device/packets_received} packets "
               "accepted",
               hand.socket->path(), counts.taken, counts.received);
  }
  if (!hand.chosen.follows_trajectory()) add_placement(report, hand);
}

// Energy along the path is the surface's alone, without what holding a force for a step adds.
void add_forces(Report& report, const HandReport& hand) {
  const TouchStatistics& s = hand.statistics;
  const StepTimes times = s.times();
  const HandEnergy energies = energy_at_hand(hand);
  report.row("computing",
             "{computing_us/p50} (p50), {computing_us/p99} (p99), {computing_us/p99.9} (p99.9), "
             "{computing_us/max} (max) per step",
             times.p50, times.p99, times.p999, times.maximum);
  report.row("contacts", "{contacts}, {contact_share} of the time", s.contacts(),
             share(s.touching(), s.steps()));
  report.row("force",
             "at most {largest_force_N}, changing by at most {largest_force_step_N} per step",
             s.largest_force(), s.largest_jump());
  if (hand.hand.tool) {
    report.row("torque", "{largest_torque_Nm} at most[; grip {largest_grip_N} at most]",
               s.largest_torque(), s.largest_grip());
  }
  report.row("energy",
             "{energy_given_to_hand_J} given to the hand[{?} (negative: absorbed from it)], "
             "{energy_along_path_J} along the path",
             energies.given, energies.given < 0, energies.path);
  report.data.update({{"energy_given_in_world_J", s.given_energy()},
                      {"energy_along_path_in_world_J", s.path_energy()}});
}

void add_compared(Report& report, const MeasuredForces& forces) {
  const MeasuredForces::Difference d = forces.difference();
  report.row("compared",
             "{compared/file}: {compared/steps} steps with a measured force of {_N} and more",
             forces.file(), d.steps, MeasuredForces::kFelt);
  report.row(
      "",
      "force differs by {compared/rms_N} RMS (median {compared/median_N}), direction by "
      "{compared/direction_deg} RMS; felt only in the file {compared/only_measured_share}, only "
      "here {compared/only_rendered_share}",
      d.rms, d.median, d.direction, d.only_measured, d.only_rendered);
}

void add_notes(Report& report, const TouchStatistics& s, bool of_tool) {
  Json& notes = report.data["notes"] = Json::array();
  for (const CountedNote& each : s.notes(of_tool)) {
    report.item("notes", {"notes", Mark::warning}, "{steps} ({_share} of steps): {text}",
                each.steps, share(each.steps, s.steps()), each.text);
    notes.back()["note"] = each.name;
  }
  if (notes.empty()) report.note("notes", "none");
}

// Advice for a hand that never touched the surface.
std::string path_to_surface(const HandReport& report) {
  const Hand& hand = report.hand;
  if (hand.plan) return "give it more time (--duration)";
  if (hand.chosen.follows_trajectory()) {
    return fmt::format("check that the trajectory is in metres and in the {}",
                       report.scales ? "cloud's frame, and --scale" : "world frame");
  }
  // A socket has reasons of single packets, too: they count where none was good.
  const bool counts = hand.socket == nullptr || hand.socket->counts().taken == 0;
  const std::string silence = counts ? hand.device->reason() : "";
  if (!silence.empty()) return silence;
  return "it starts 2 mm in front of the surface, plus its offset if it has one; --view shows "
         "where it moves";
}

}  // namespace

HandEnergy energy_at_hand(const HandReport& report) {
  const double scale = report.hand.workspace.scale;
  const TouchStatistics& s = report.statistics;
  return {s.given_energy() / scale, s.path_energy() / scale};
}

std::vector<std::string> advice(const HandReport& report) {
  std::vector<std::string> sentences;
  if (report.statistics.touching() == 0) {
    sentences.push_back(report.surface
                            ? "the hand never touched the surface: " + path_to_surface(report)
                            : kNoSurface);
  }
  const double scale = report.hand.workspace.scale;
  const double felt = scale * report.stiffness;
  if (felt > kSteadyStiffness) {
    sentences.push_back(
        fmt::format("{:.4g} N/m at the hand is too stiff for a sampled force to stay passive; give "
                    "a --stiffness up to {:.4g}",
                    felt, kSteadyStiffness / scale));
  }
  return sentences;
}

Report report_of(const HandReport& hand, const std::string& title) {
  const TouchStatistics& s = hand.statistics;
  const bool real = hand.live != nullptr;
  Report report(title,
                fmt::format("{} field, {:.4g} N/m, {} device", name_in(kFields, hand.field.kind),
                            hand.stiffness, hand.hand.device->info().name));
  add_device(report, hand.hand);
  report.row(
      "steps",
      real ? "{steps} in {real_s} of real time" : "{steps} in {simulated_s} of simulated time",
      s.steps(), s.duration());
  report.row("ended", "[by Ctrl-C{interrupted}]", hand.interrupted);
  if (real) add_live(report, *hand.live);
  if (hand.unguarded != nullptr) add_unguarded(report, *hand.unguarded);
  add_forces(report, hand);
  if (hand.compared != nullptr) add_compared(report, *hand.compared);
  add_notes(report, s, hand.hand.tool != nullptr);
  report.data["advice"] = advice(hand);
  for (const std::string& sentence : advice(hand)) report.note({"advice", Mark::warning}, sentence);
  if (!hand.unlogged.empty()) report.row({"log", Mark::error}, "{log_problem}", hand.unlogged);
  return report;
}

}  // namespace palpate::app
