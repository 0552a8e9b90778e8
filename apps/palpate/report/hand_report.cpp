#include "apps/palpate/report/hand_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app {

namespace {

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

void print_scale(const Hand& hand, std::FILE* out) {
  const double scale = hand.workspace.scale;
  if (scale == 1) return;
  fmt::print(out,
             "  scale      1 m of the hand is {} m of the cloud; {:.4g} N/m there is {:.4g} N/m to "
             "the hand\n",
             scale, hand.stiffness, hand.workspace.felt_stiffness(hand.stiffness));
}

void print_plan(const Hand& hand, std::FILE* out) {
  fmt::print(out, "  explored   up to {} across, pressing about {} deep\n",
             length(hand.plan->patch), length(hand.plan->depth));
  print_scale(hand, out);
}

// The second number is the surface's alone, without what holding a force for a step adds.
void print_energy(const HandEnergy& hand, std::FILE* out) {
  fmt::print(out, "  energy     {} given to the hand{}, {} along the path\n", energy(hand.given),
             hand.given < 0 ? " (negative: taken from it)" : "", energy(hand.path));
}

void print_notes(const TouchStatistics& s, const Style& style, std::FILE* out) {
  bool any = false;
  for (std::size_t i = 0; i < TouchStatistics::kNotes; ++i) {
    if (s.notes()[i] == 0) continue;
    fmt::print(out, "  {} {} ({:.3g} % of steps): {}\n",
               style.warning(any ? "          " : "notes     "), grouped(s.notes()[i]),
               100 * share(s.notes()[i], s.steps()), note_text(i).text);
    any = true;
  }
  if (!any) fmt::print(out, "  notes      none\n");
}

Json json_notes(const TouchStatistics& s) {
  Json notes = Json::array();
  for (std::size_t i = 0; i < TouchStatistics::kNotes; ++i) {
    if (s.notes()[i] == 0) continue;
    notes.push_back(
        {{"note", note_text(i).name}, {"steps", s.notes()[i]}, {"text", note_text(i).text}});
  }
  return notes;
}

void print_unguarded(const Unguarded& run, std::FILE* out) {
  const GuardCounts& counts = run.counts();
  std::string words;
  if (counts.slewed > 0) {
    words += fmt::format("; {} steps one would have slowed (largest {:.2g} N in a step)",
                         grouped(counts.slewed), run.largest_change());
  }
  if (counts.clamped > 0) {
    words += fmt::format("; {} steps one would have shortened to {:.3g} N", grouped(counts.clamped),
                         run.limits().maximum_force);
  }
  fmt::print(out, "  guard      none in simulated time{}\n",
             words.empty() ? "; one would have let every force pass" : words);
}

// JSON has no infinity: null is no limit.
Json json_unguarded(const Unguarded& run) {
  const double most = run.limits().maximum_force;
  return {{"slew_N_per_s", run.limits().slew},
          {"maximum_force_N", std::isfinite(most) ? Json(most) : Json()},
          {"would_slow_steps", run.counts().slewed},
          {"largest_slowed_step_N", run.largest_change()},
          {"would_shorten_steps", run.counts().clamped}};
}

void print_socket(const RemoteDevice& socket, std::FILE* out) {
  const RemoteCounts counts = socket.counts();
  fmt::print(out, "  socket     {}: {} packets taken of {}\n", socket.path(), grouped(counts.taken),
             grouped(counts.received));
}

// Where a device stands that nobody leads.
void print_stand(const Hand& hand, std::FILE* out) {
  const Eigen::Vector3d& origin = hand.workspace.T_world_device.translation();
  fmt::print(out, "  stands     its origin at {:.4g}, {:.4g}, {:.4g} m, axes as {}\n", origin.x(),
             origin.y(), origin.z(), hand.camera.empty() ? "the world's" : hand.camera + " looks");
  print_scale(hand, out);
  if (hand.clutch) fmt::print(out, "  clutch     button {}\n", *hand.clutch);
}

Json json_device(const HandReport& report) {
  const Hand& hand = report.hand;
  Json device = {{"name", hand.device->info().name}};
  if (!hand.plan && hand.led) return device;
  device["scale"] = hand.workspace.scale;
  device["felt_stiffness_N_per_m"] = hand.workspace.felt_stiffness(hand.stiffness);
  if (hand.plan) {
    device["explored_m"] = hand.plan->patch;
    device["depth_m"] = hand.plan->depth;
  }
  if (hand.led) return device;
  const Eigen::Vector3d& origin = hand.workspace.T_world_device.translation();
  device["origin_m"] = {origin.x(), origin.y(), origin.z()};
  if (!hand.camera.empty()) device["frame"] = hand.camera;
  if (hand.clutch) device["clutch_button"] = *hand.clutch;
  if (hand.socket == nullptr) return device;
  const RemoteCounts counts = hand.socket->counts();
  device["socket"] = hand.socket->path();
  device["packets_received"] = counts.received;
  device["packets_taken"] = counts.taken;
  return device;
}

// Of a hand that felt nothing.
std::string way_to_surface(const HandReport& report) {
  const Hand& hand = report.hand;
  if (hand.plan) return "give it more time (--duration)";
  if (hand.led) {
    return fmt::format("is the trajectory in metres and in the {}?",
                       report.scales ? "cloud's frame, and --scale right" : "world's frame");
  }
  // A socket has reasons of single packets, too: they count where none was good.
  const bool counts = hand.socket == nullptr || hand.socket->counts().taken == 0;
  const std::string silence = counts ? hand.device->reason() : "";
  if (!silence.empty()) return silence;
  return "it starts 2 mm in front of the surface, moved by its offset if it has one; --view shows "
         "where it goes";
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
    sentences.push_back("the hand never met the surface: " + way_to_surface(report));
  }
  const double scale = report.hand.workspace.scale;
  const double felt = scale * report.stiffness;
  if (felt > kStiffest) {
    sentences.push_back(
        fmt::format("{:.4g} N/m to the hand is stiffer than forces held for a step can be without "
                    "giving it energy; a --stiffness up to {:.4g} is steady",
                    felt, kStiffest / scale));
  }
  return sentences;
}

void print_hand(const HandReport& report, const std::string& title, std::FILE* out) {
  const Style style(out);
  const Hand& hand = report.hand;
  const TouchStatistics& s = report.statistics;
  const StepTimes times = s.times();
  fmt::print(out, "{} {} field, {:.4g} N/m, {} device\n", style.heading(title),
             name_in(kFields, report.field.kind), report.stiffness, hand.device->info().name);
  if (hand.plan) print_plan(hand, out);
  if (hand.socket != nullptr) print_socket(*hand.socket, out);
  if (!hand.led) print_stand(hand, out);
  fmt::print(out, "  steps      {} in {:.4g} s of {} time\n", grouped(s.steps()), s.duration(),
             report.live == nullptr ? "simulated" : "real");
  if (report.interrupted) fmt::print(out, "  ended      by Ctrl-C\n");
  if (report.live != nullptr) print_live(*report.live, out);
  if (report.unguarded != nullptr) print_unguarded(*report.unguarded, out);
  fmt::print(out, "  computing  p50 {:.1f}  p99 {:.1f}  p99.9 {:.1f}  max {:.1f} us a step\n",
             times.p50, times.p99, times.p999, times.maximum);
  fmt::print(out, "  contacts   {}, {:.3g} % of the time\n", grouped(s.contacts()),
             100 * share(s.touching(), s.steps()));
  fmt::print(out, "  force      {:.3g} N at most, changing by {:.2g} N a step at most\n",
             s.largest_force(), s.largest_jump());
  print_energy(energy_at_hand(report), out);
  print_notes(s, style, out);
  for (const std::string& sentence : advice(report)) {
    fmt::print(out, "  {} {}\n", style.warning("advice    "), sentence);
  }
}

Json json_hand(const HandReport& report) {
  const TouchStatistics& s = report.statistics;
  const StepTimes times = s.times();
  const HandEnergy energies = energy_at_hand(report);
  Json json = {
      {"device", json_device(report)},
      {"steps", s.steps()},
      {report.live == nullptr ? "simulated_s" : "real_s", s.duration()},
      {"interrupted", report.interrupted},
      {"computing_us",
       {{"p50", times.p50}, {"p99", times.p99}, {"p99.9", times.p999}, {"max", times.maximum}}},
      {"contacts", s.contacts()},
      {"contact_share", share(s.touching(), s.steps())},
      {"largest_force_N", s.largest_force()},
      {"largest_force_step_N", s.largest_jump()},
      {"energy_given_to_hand_J", energies.given},
      {"energy_along_path_J", energies.path},
      {"energy_given_in_world_J", s.given_energy()},
      {"energy_along_path_in_world_J", s.path_energy()},
      {"notes", json_notes(s)},
      {"advice", advice(report)}};
  if (report.live != nullptr) json["live"] = json_live(*report.live);
  if (report.unguarded != nullptr) json["unguarded"] = json_unguarded(*report.unguarded);
  return json;
}

}  // namespace palpate::app
