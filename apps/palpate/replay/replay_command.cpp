// The command replay: compares forces or opens the page.
#include "apps/palpate/replay/replay_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <vector>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "apps/palpate/options/page_options.hpp"
#include "apps/palpate/replay/replay.hpp"
#include "apps/palpate/replay/replay_view.hpp"
#include "apps/palpate/report/log.hpp"
#include "apps/palpate/report/report.hpp"

namespace palpate::app {

namespace {

constexpr const char* kReplayFooter = R"(Examples:
  palpate touch synthetic:torus --record run.mcap
  palpate replay run.mcap
  palpate replay run.mcap --view

The same program on the same kind of processor gives the same forces, bit for bit: the largest
difference is 0. --view shows what was recorded, at any moment, and computes no force.
docs/bags.md says what is recorded.

Exit codes: 0 the forces are the same, 1 they differ or the file cannot be read, 2 the command line
is wrong.)";

Report report_of(const ForceDifference& found) {
  const bool differs = found.differing > 0;
  Report report(found.topic, fmt::format("{} steps", grouped(found.steps)));
  report.data = {{"topic", found.topic}, {"steps", found.steps}, {"exact", found.exact()}};
  report.row({"difference", differs ? Mark::error : Mark::plain},
             "{largest_difference_N} at most, {rms_difference_N} rms, in {differing_steps} steps",
             found.largest, found.rms(), found.differing);
  if (found.largest_torque) {
    report.row({"", differs ? Mark::error : Mark::plain},
               "{largest_torque_difference_Nm} of torques", *found.largest_torque);
  }
  report.row("first", "[{?}step {first_step}, {first_time_s} after the hand's first]", differs,
             differs ? Json(found.first) : Json(), differs ? Json(found.first_time) : Json());
  report.row({"ended", Mark::error}, "[{ended}]", found.ended);
  return report;
}

ForceDifference replay_hand(const Replay& run, std::size_t hand, const std::string& log) {
  std::optional<TouchLog> steps;
  if (!log.empty()) steps.emplace(numbered_path(log, hand), run.turns(hand));
  const Waiting waiting(fmt::format("replaying hand {}", hand + 1));
  const auto add = [&](const ServoState& step, const DeviceInfo& device) {
    if (steps) steps->add(step, device, run.scale(hand));
  };
  ForceDifference found = run.run(hand, add);
  if (found.steps == 0 && steps) run.show(hand, add);  // then as they were
  if (steps) steps->close();
  return found;
}

}  // namespace

void add_replay_options(CLI::App& command, ReplayCommand& replay) {
  command.footer(kReplayFooter);
  command.add_option("file", replay.input, "what palpate touch --record wrote")
      ->required()
      ->type_name("FILE");
  command.add_option("--json", replay.json, "the report as JSON; - is standard output")
      ->type_name("FILE");
  command
      .add_option("--log", replay.log,
                  "CSV with one row per servo step of the replay, as touch --log; - is standard "
                  "output")
      ->type_name("FILE");
  OptionTable table(command);
  table.under("Page");
  table.add_flag("--view", replay.page.wanted,
                 "show what was recorded on a page in a browser, with a time line, until Ctrl-C");
  add_page_options(table, replay.page);
}

namespace {

// The page alone, or what is done again alone.
void check(const ReplayCommand& command) {
  const PagePlan& page = command.page;
  if (page.wanted && !(command.json.empty() && command.log.empty())) {
    throw UsageError("--view does nothing again; remove --json and --log, or --view");
  }
  if (!page.wanted && (page.headless || page.port || !page.address.empty())) {
    throw UsageError("--headless, --listen and --port apply only to the page; add --view");
  }
}

}  // namespace

int replay(const ReplayCommand& command) {
  check(command);
  if (command.page.wanted) {
    view_recording(command.input, command.page);
    return kSuccess;
  }
  const Replay run(command.input);
  if (command.log == "-" && (command.json == "-" || run.hands() > 1)) {
    throw UsageError("--log cannot go to standard output beside --json or another hand's log");
  }
  std::vector<NamedFile> written = {{"--json", command.json}};
  for (std::size_t hand = 0; hand < run.hands(); ++hand) {
    written.push_back({"--log", numbered_path(command.log, hand)});
  }
  check_distinct({{"the recording", command.input}}, written);
  std::optional<OutputFile> json = output_at(command.json);
  Json hands = Json::array();
  bool exact = true;
  for (std::size_t hand = 0; hand < run.hands(); ++hand) {
    const ForceDifference found = replay_hand(run, hand, command.log);
    Report report = report_of(found);
    report.print(command.json == "-" || command.log == "-" ? stderr : stdout);
    hands.push_back(report.data);
    exact = exact && found.exact();
  }
  write_whole(json, text_of({{"file", command.input}, {"exact", exact}, {"hands", hands}}));
  return exact ? kSuccess : kFailure;
}

}  // namespace palpate::app
