#include "apps/palpate/zwidth/zwidth_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/plot/python_drawing.hpp"

namespace palpate::app {

namespace {

constexpr const char* kZWidthFooter = R"(Examples:
  palpate zwidth
  palpate zwidth --device-profile omega --picture omega.png
  palpate zwidth --device-profile my-arm --profiles arms.toml --csv arm.csv
  palpate zwidth --device forcedimension

A profile file is TOML with one table per device and any of these keys: title, source,
maximum_force, peak_force (N), maximum_stiffness (N/m), damping (N s/m), coulomb (N), mass (kg),
resolution, workspace_radius (m), rate (Hz), delay (s).

By default the walls are simulated and nothing moves: a mass with friction, quantised positions and
a sampled, delayed force. With --device, a person presses on walls that the device renders, each
stiffer than the last, until one makes it vibrate; palpate explains this and asks before it starts.)";

// Every file is made before the work: a place that does not exist is told at once.
struct ZWidthOutputs {
  std::optional<OutputFile> csv;
  std::optional<OutputFile> json;
  std::optional<OutputFile> picture;

  explicit ZWidthOutputs(const ZWidthOptions& options) {
    check_distinct(
        {}, {{"--csv", options.csv}, {"--json", options.json}, {"--picture", options.picture}});
    check_picture(options.picture);
    if (!options.csv.empty()) csv.emplace(options.csv);
    if (!options.json.empty()) json.emplace(options.json);
    if (!options.picture.empty()) picture.emplace(options.picture);
  }
};

void add_simulation_options(CLI::App& command, ZWidthOptions& o) {
  command
      .add_option("--device-profile", o.profile,
                  wrapped("device profile: simulated (default), unknown, touch, omega, falcon, ... "
                          "or one from --profiles"))
      ->type_name("NAME");
  command.add_option("--profiles", o.profiles, "TOML file with your own profiles")
      ->type_name("FILE");
  command.add_option("--rate", o.rates, "servo rates (500 to 4000, and the device's own)")
      ->delimiter(',')
      ->check(number("between 100 and 20000 Hz", [](double x) { return x >= 100 && x <= 2e4; }))
      ->type_name("HZ,...");
  command.add_option("--delay", o.delays, "delays from position to force, in steps (0,1,2)")
      ->delimiter(',')
      ->check(whole_number(0, 16))
      ->type_name("N,...");
  command
      .add_option("--damping", o.dampings,
                  wrapped("physical damping of the device (from its profile, else 0.1 to 2)"))
      ->delimiter(',')
      ->check(not_negative())
      ->type_name("N S/M,...");
  command.add_option("--wall-damping", o.wall_damping, "virtual damping B of the wall (0)")
      ->check(not_negative())
      ->type_name("N S/M");
  command.add_option("--csv", o.csv, "the map as CSV; - is standard output")->type_name("FILE");
  add_json_option(command, o.json);
  command.add_option("--picture", o.picture, "the map as PNG (needs python3-matplotlib)")
      ->type_name("FILE.png");
}

// With --device, which excludes what is of simulated walls alone.
void add_hardware_options(CLI::App& command, StiffnessTestRunOptions& trial) {
  CLI::Option* const device =
      command
          .add_option(
              "--device", trial.device,
              wrapped(
                  "measure on this device ('palpate devices' lists them); asks before it starts"))
          ->group("On hardware");
  std::string text = "NAME Excludes:";  // of its own, CLI11 would list them by their addresses
  for (const char* simulated :
       {"--device-profile", "--profiles", "--rate", "--delay", "--damping", "--csv", "--picture"}) {
    device->excludes(command.get_option(simulated));
    text += fmt::format(" {}", simulated);
  }
  device->option_text(text);
  const auto on_hardware = [&](CLI::Option* option) {
    return option->needs(device)->group("On hardware");
  };
  on_hardware(
      command.add_flag("--confirm", trial.confirmed, "do not ask; somebody holds the device"));
  on_hardware(command.add_option("--maximum-force", trial.trial.maximum_force,
                                 "largest force of a wall (2; at most 4)"))
      ->check(number("above 0.3, up to 4 N", [](double x) { return x > 0.3 && x <= 4; }))
      ->type_name("N");
  on_hardware(command.add_option("--patience", trial.trial.patience,
                                 wrapped("stop after this long without progress (30)")))
      ->check(positive())
      ->type_name("SECONDS");
}

}  // namespace

void add_zwidth_options(CLI::App& command, ZWidthChoices& choices) {
  add_simulation_options(command, choices.map);
  add_hardware_options(command, choices.trial);
  command.footer(kZWidthFooter);
}

void zwidth(const ZWidthChoices& choices) {
  const ZWidthOptions& options = choices.map;
  if (!choices.trial.device.empty()) {
    StiffnessTestRunOptions trial = choices.trial;
    trial.trial.damping = options.wall_damping;
    trial.json = options.json;
    return run_stiffness_test(trial);
  }
  ZWidthOutputs outputs(options);
  const ZWidthMap map = [&] {
    Progress progress("simulating walls");
    return measure_zwidth(options, [&](double done) { progress.update(done); });
  }();
  print_zwidth(map, options.csv == "-" || options.json == "-" ? stderr : stdout);
  write_whole(outputs.csv, csv(map));
  write_whole(outputs.json, facts(map) + "\n");
  if (!outputs.picture) return;
  const Waiting waiting("drawing the picture");
  draw_by_python(figures_script(), {{"facts.json", facts(map)}, {"table.csv", csv(map)}},
                 options.picture, *outputs.picture);
}

}  // namespace palpate::app
