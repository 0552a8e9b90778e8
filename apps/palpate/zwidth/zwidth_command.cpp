// The command zwidth: simulates how stiff a wall may be.
#include "apps/palpate/zwidth/zwidth_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/plot/python_drawing.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/device.hpp"
#include "palpate/servo/z_width.hpp"

namespace palpate::app {
namespace {

// How stiff a wall may be on one device at one pace; N/m.
struct ZWidthRow {
  double rate = 0;     // Hz
  int delay = 0;       // steps
  double damping = 0;  // of the device, N s/m
  double colgate = 0;  // 2 (b + B) / (T + 2 T_d)
  double stable = 0;   // oscillations do not grow
  double passive = 0;  // no impact comes out faster than it went in
  double braked = 0;   // the same, with the guard's brake
};

struct ZWidthMap {
  DeviceProfile profile;
  double mass = 0;        // kg, as simulated
  double resolution = 0;  // m
  double coulomb = 0;     // N
  double wall_damping = 0;
  std::vector<ZWidthRow> rows;
};

// The name of a profile for which none was requested.
std::string usual_profile(const std::string& file, const std::vector<DeviceProfile>& among) {
  if (file.empty()) return "simulated";
  if (among.size() == 1) return among.front().name;
  std::string names;
  for (const DeviceProfile& each : among) names += (names.empty() ? "" : ", ") + each.name;
  throw UsageError(fmt::format("--profiles {} has {}; say which by --device-profile", file, names));
}

DeviceProfile find_profile(const ZWidthOptions& options) {
  const std::vector<DeviceProfile> among =
      options.profiles.empty() ? device_profiles() : read_device_profiles(options.profiles);
  const std::string name =
      options.profile.empty() ? usual_profile(options.profiles, among) : options.profile;
  return suggesting(name, among, [&] { return device_profile(name, among); });
}

SimulatedDeviceOptions device_of(const DeviceProfile& profile) {
  SimulatedDeviceOptions device;
  device.mass = profile.mass.value_or(device.mass);
  device.coulomb = profile.coulomb.value_or(0);
  device.resolution = profile.resolution.value_or(device.resolution);
  device.rate = profile.rate.value_or(device.rate);
  return device;
}

std::vector<double> rates(const ZWidthOptions& options, const DeviceProfile& profile) {
  if (!options.rates.empty()) return options.rates;
  std::vector<double> all = {500, 1000, 2000, 4000};
  const double own = profile.rate.value_or(1000);
  if (std::ranges::find(all, own) == all.end()) all.push_back(own);
  std::ranges::sort(all);
  return all;
}

std::vector<double> dampings(const ZWidthOptions& options, const DeviceProfile& profile) {
  if (!options.dampings.empty()) return options.dampings;
  if (profile.damping) return {*profile.damping};
  return {0.1, 0.2, 0.5, 1, 2};
}

std::vector<int> delays(const ZWidthOptions& options) {
  return options.delays.empty() ? std::vector<int>{0, 1, 2} : options.delays;
}

ZWidthRow measure(WallOptions wall) {
  ZWidthRow row;
  row.rate = wall.device.rate;
  row.delay = wall.device.delay;
  row.damping = wall.device.damping;
  row.colgate =
      passive_stiffness(row.damping + wall.guard.damping, 1 / row.rate, row.delay / row.rate);
  wall.guard.passivity.on = false;
  row.stable = stable_stiffness(wall);
  row.passive = rebound_stiffness(wall);
  wall.guard.passivity.on = true;
  row.braked = rebound_stiffness(wall);
  return row;
}

// "> N" where the limit is above the stiffest wall that is tried.
std::string stiffness(double newtons_per_metre) {
  if (newtons_per_metre >= kStiffestWall) return fmt::format("> {:.0f}", kStiffestWall);
  return fmt::format("{:.0f}", newtons_per_metre);
}

// Simulates every combination of rate, delay and damping. `progress` gets 0 to 1.
ZWidthMap measure_zwidth(const ZWidthOptions& options,
                         const std::function<void(double)>& progress) {
  ZWidthMap map;
  map.profile = find_profile(options);
  WallOptions wall;
  wall.device = device_of(map.profile);
  wall.guard.damping = options.wall_damping;
  map.mass = wall.device.mass;
  map.resolution = wall.device.resolution;
  map.coulomb = wall.device.coulomb;
  map.wall_damping = options.wall_damping;
  const std::vector<double> all_rates = rates(options, map.profile);
  const std::vector<int> all_delays = delays(options);
  const std::vector<double> all_dampings = dampings(options, map.profile);
  const std::size_t count = all_rates.size() * all_delays.size() * all_dampings.size();
  for (const double rate : all_rates) {
    for (const int delay : all_delays) {
      for (const double damping : all_dampings) {
        wall.device.rate = rate;
        wall.device.delay = delay;
        wall.device.damping = damping;
        map.rows.push_back(measure(wall));
        progress(static_cast<double>(map.rows.size()) / static_cast<double>(count));
      }
    }
  }
  return map;
}

void print_zwidth(const ZWidthMap& map, std::FILE* out) {
  const Style style(out);
  fmt::print(out, "{} {}: largest wall stiffness, N/m\n", style.heading("z-width"),
             map.profile.title);
  fmt::print(out,
             "simulated with {:.3g} kg, Coulomb friction {:.3g} N, position resolution {}, wall "
             "damping {:.3g} N s/m\n",
             map.mass, map.coulomb, length(map.resolution), map.wall_damping);
  fmt::print(out, "{:>8} {:>6} {:>9} {:>9} {:>9} {:>9} {:>11}\n", "rate", "delay", "damping",
             "Colgate", "stable", "passive", "with brake");
  for (const ZWidthRow& row : map.rows) {
    fmt::print(out, "{:>5.0f} Hz {:>6} {:>9.3g} {:>9.0f} {:>9} {:>9} {:>11}\n", row.rate, row.delay,
               row.damping, row.colgate, stiffness(row.stable), stiffness(row.passive),
               stiffness(row.braked));
  }
  fmt::print(out,
             "delay: steps from a position to its force; damping: of the device, N s/m\nColgate: 2 "
             "(b + B) / (T + 2 T_d); stable: oscillations of the released device do not "
             "grow;\npassive: it leaves the wall no faster than it entered; with brake: the same "
             "with the guard's passivity controller\n");
  if (map.profile.damping && map.profile.mass) return;
  fmt::print(out,
             "{} the mass or friction of this device is unknown and was assumed: the map is a "
             "guide, not a measurement\n",
             style.warning("note:"));
}

std::string csv(const ZWidthMap& map) {
  std::string text =
      "rate_Hz,delay_steps,damping_Ns_per_m,wall_damping_Ns_per_m,colgate_N_per_m,stable_N_per_m,"
      "passive_N_per_m,braked_N_per_m\n";
  for (const ZWidthRow& row : map.rows) {
    text +=
        fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g}\n", row.rate, row.delay, row.damping,
                    map.wall_damping, row.colgate, row.stable, row.passive, row.braked);
  }
  return text;
}

// The result as JSON, also the input of figures.py.
Json facts(const ZWidthMap& map) {
  Json rows = Json::array();
  for (const ZWidthRow& row : map.rows) {
    rows.push_back({{"rate_Hz", row.rate},
                    {"delay_steps", row.delay},
                    {"damping_Ns_per_m", row.damping},
                    {"colgate_N_per_m", row.colgate},
                    {"stable_N_per_m", row.stable},
                    {"passive_N_per_m", row.passive},
                    {"braked_N_per_m", row.braked}});
  }
  return Json{{"figure", "zwidth"},
              {"device", map.profile.title},
              {"source", map.profile.source},
              {"mass_kg", map.mass},
              {"coulomb_N", map.coulomb},
              {"resolution_m", map.resolution},
              {"wall_damping_Ns_per_m", map.wall_damping},
              {"stiffest_N_per_m", kStiffestWall},
              {"rows", rows}};
}

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
  FigureFiles files(options.csv, options.json, options.picture);
  const ZWidthMap map = [&] {
    Progress progress("simulating walls");
    return measure_zwidth(options, [&](double done) { progress.update(done); });
  }();
  print_zwidth(map, options.csv == "-" || options.json == "-" ? stderr : stdout);
  files.write(csv(map), facts(map));
}

}  // namespace palpate::app
