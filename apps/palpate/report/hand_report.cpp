#include "apps/palpate/report/hand_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app {

namespace {

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// "12 steps slew-limited, 3 steps force-limited"; empty: it never intervened.
std::string guard_words(const Guard::State::Counts& counts) {
  std::string words;
  const auto add = [&words](std::uint64_t count, std::string_view text) {
    if (count == 0) return;
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", grouped(count), text);
  };
  add(counts.slewed, "steps slew-limited");
  add(counts.clamped, "steps force-limited");
  add(counts.braked, "steps braked to dissipate energy given to the hand");
  add(counts.starting, "steps in a soft start");
  add(counts.softened, "steps with stiffness reduced to the device's limit");
  add(counts.silences, "watchdog stops");
  add(counts.faults, "faults");
  return words;
}

Json add_guard(Report& report, const GuardOptions& limits, const Guard::State& guard) {
  const Guard::State::Counts& counts = guard.counts;
  const std::string words = guard_words(counts);
  const std::string most = std::isfinite(limits.maximum_force)
                               ? fmt::format("at most {:.3g} N", limits.maximum_force)
                               : "no force limit";
  report.line("guard", fmt::format("{}, {:.3g} N/s, watchdog {}: {}", most, limits.slew,
                                   std::isinf(limits.silence) ? "none" : duration(limits.silence),
                                   words.empty() ? "no intervention" : words));
  const std::string fault(in_words(guard.fault));
  if (guard.fault != Guard::Fault::none) report.line("fault", fault, Mark::warning);
  return {{"maximum_force_N", limit(limits.maximum_force)},
          {"slew_N_per_s", limits.slew},
          {"watchdog_s", limits.silence},
          {"damping_Ns_per_m", limits.damping},
          {"soft_start_s", limits.soft_start},
          {"passivity", limits.passivity.on},
          {"slewed", counts.slewed},
          {"clamped", counts.clamped},
          {"braked", counts.braked},
          {"starting", counts.starting},
          {"softened", counts.softened},
          {"silences", counts.silences},
          {"faults", counts.faults},
          {"fault", fault}};
}

Json add_requests(Report& report, const std::vector<RealtimeReport::Request>& requests) {
  Json data = Json::array();
  for (const RealtimeReport::Request& each : requests) {
    data.push_back({{"what", each.what}, {"granted", each.granted}, {"remedy", each.remedy}});
    if (each.granted) {
      report.line("real time", fmt::format("{}: granted", each.what));
    } else {
      report.line("real time", fmt::format("{}: not granted: {}", each.what, each.remedy),
                  Mark::warning);
    }
  }
  return data;
}

// How well time was kept, what the guard did, what the system granted.
Json add_live(Report& report, const LiveReport& live) {
  const double p50 = live.lateness.quantile(0.5);
  const double p99 = live.lateness.quantile(0.99);
  const double longest = live.lateness.longest;
  report.line("pace",
              fmt::format("{:.4g} Hz; late by {} (p50), {} (p99), {} (max); steps skipped: {}",
                          live.rate, duration(p50), duration(p99), duration(longest),
                          live.skipped == 0 ? "none" : grouped(live.skipped)));
  if (live.unwritten > 0) {
    report.line(
        "unwritten",
        fmt::format(
            "{} steps were not recorded because they came too fast; they are missing from the log",
            grouped(live.unwritten)),
        Mark::warning);
  }
  Json data = {{"rate_Hz", live.rate},
               {"late_s", {{"p50", p50}, {"p99", p99}, {"max", longest}}},
               {"steps_left_out", live.skipped},
               {"steps_unwritten", live.unwritten}};
  data["guard"] = add_guard(report, live.limits, live.guard);
  data["realtime"] = add_requests(report, live.realtime.requests);
  data["failure"] = live.failure;
  if (!live.failure.empty()) report.line("FAILED", live.failure, Mark::error);
  return data;
}

Json add_unguarded(Report& report, const Unguarded& run) {
  const Guard::State::Counts& counts = run.counts();
  std::string words;
  if (counts.slewed > 0) {
    words += fmt::format("; it would have slew-limited {} steps (largest {:.2g} N in a step)",
                         grouped(counts.slewed), run.largest_change());
  }
  if (counts.clamped > 0) {
    words += fmt::format("; it would have limited {} steps to {:.3g} N", grouped(counts.clamped),
                         run.limits().maximum_force);
  }
  if (words.empty()) words = "; it would not have intervened";
  report.line("guard", "none in simulated time" + words);
  return {{"slew_N_per_s", run.limits().slew},
          {"maximum_force_N", limit(run.limits().maximum_force)},
          {"would_slow_steps", counts.slewed},
          {"largest_slowed_step_N", run.largest_change()},
          {"would_shorten_steps", counts.clamped}};
}

void add_scale(Report& report, const Hand& hand) {
  const double scale = hand.workspace.scale;
  const double felt = hand.workspace.felt_stiffness(hand.stiffness);
  report.data["device"].update({{"scale", scale}, {"felt_stiffness_N_per_m", felt}});
  if (scale == 1) return;
  report.line(
      "scale",
      fmt::format(
          "1 m of hand motion is {} m in the cloud; {:.4g} N/m there is {:.4g} N/m at the hand",
          scale, hand.stiffness, felt));
}

// Pose of a device that a person or a program moves.
void add_placement(Report& report, const Hand& hand) {
  Json& device = report.data["device"];
  const Eigen::Vector3d& origin = hand.workspace.T_world_device.translation();
  const PlacementOptions& placement = hand.chosen.placement;
  report.line(
      "origin",
      fmt::format("{:.4g}, {:.4g}, {:.4g} m, axes {}", origin.x(), origin.y(), origin.z(),
                  placement.frame.empty() ? "of the world" : "as " + placement.frame + " looks"));
  add_scale(report, hand);
  device["origin_m"] = {origin.x(), origin.y(), origin.z()};
  if (!placement.frame.empty()) device["frame"] = placement.frame;
  if (!placement.clutch) return;
  report.line("clutch", fmt::format("button {}", *placement.clutch));
  device["clutch_button"] = *placement.clutch;
}

void add_device(Report& report, const Hand& hand) {
  Json& device = report.data["device"];
  device = {{"name", hand.device->info().name}};
  if (hand.plan) {
    report.line("explored", fmt::format("an area up to {} across, pressing about {} deep",
                                        length(hand.plan->patch), length(hand.plan->depth)));
    add_scale(report, hand);
    device.update({{"explored_m", hand.plan->patch}, {"depth_m", hand.plan->depth}});
  }
  RemoteDevice::Counts counts;
  if (hand.socket != nullptr) {
    counts = hand.socket->counts();
    report.line("socket", fmt::format("{}: {} of {} packets accepted", hand.socket->path(),
                                      grouped(counts.taken), grouped(counts.received)));
  }
  if (!hand.chosen.follows_trajectory()) add_placement(report, hand);
  if (hand.socket == nullptr) return;
  device["socket"] = hand.socket->path();
  device["packets_received"] = counts.received;
  device["packets_taken"] = counts.taken;
}

// The second energy is the surface's alone, without what holding a force for a step adds.
void add_forces(Report& report, const HandReport& hand) {
  const TouchStatistics& s = hand.statistics;
  const StepTimes times = s.times();
  const HandEnergy energies = energy_at_hand(hand);
  const double touching = share(s.touching(), s.steps());
  report.line("computing",
              fmt::format("p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f}  max {:.1f} us per step", times.p50,
                          times.p99, times.p999, times.maximum));
  report.line("contacts",
              fmt::format("{}, {:.3g} % of the time", grouped(s.contacts()), 100 * touching));
  report.line("force", fmt::format("at most {:.3g} N, changing by at most {:.2g} N per step",
                                   s.largest_force(), s.largest_jump()));
  report.line("energy",
              fmt::format("{} given to the hand{}, {} along the path", energy(energies.given),
                          energies.given < 0 ? " (negative: absorbed from it)" : "",
                          energy(energies.path)));
  report.data.update(
      {{"computing_us",
        {{"p50", times.p50}, {"p99", times.p99}, {"p99.9", times.p999}, {"max", times.maximum}}},
       {"contacts", s.contacts()},
       {"contact_share", touching},
       {"largest_force_N", s.largest_force()},
       {"largest_force_step_N", s.largest_jump()},
       {"energy_given_to_hand_J", energies.given},
       {"energy_along_path_J", energies.path},
       {"energy_given_in_world_J", s.given_energy()},
       {"energy_along_path_in_world_J", s.path_energy()}});
}

void add_notes(Report& report, const TouchStatistics& s) {
  Json& data = report.data["notes"] = Json::array();
  for (const CountedNote& each : s.notes()) {
    report.line(data.empty() ? "notes" : "",
                fmt::format("{} ({:.3g} % of steps): {}", grouped(each.steps),
                            100 * share(each.steps, s.steps()), each.text),
                Mark::warning);
    data.push_back({{"note", each.name}, {"steps", each.steps}, {"text", each.text}});
  }
  if (data.empty()) report.line("notes", "none");
}

// Of a hand that felt nothing.
std::string way_to_surface(const HandReport& report) {
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
                            ? "the hand never touched the surface: " + way_to_surface(report)
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
  report.line("steps", fmt::format("{} in {:.4g} s of {} time", grouped(s.steps()), s.duration(),
                                   real ? "real" : "simulated"));
  report.data.update({{"steps", s.steps()},
                      {real ? "real_s" : "simulated_s", s.duration()},
                      {"interrupted", hand.interrupted}});
  if (hand.interrupted) report.line("ended", "by Ctrl-C");
  const Json live = real ? add_live(report, *hand.live) : Json();
  const bool unguarded = hand.unguarded != nullptr;
  const Json other = unguarded ? add_unguarded(report, *hand.unguarded) : Json();
  add_forces(report, hand);
  add_notes(report, s);
  report.data["advice"] = advice(hand);
  for (const std::string& sentence : advice(hand)) report.line("advice", sentence, Mark::warning);
  if (real) report.data["live"] = live;
  if (unguarded) report.data["unguarded"] = other;
  return report;
}

}  // namespace palpate::app
