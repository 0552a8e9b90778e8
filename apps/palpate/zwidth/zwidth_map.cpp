#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/zwidth/zwidth_command.hpp"
#include "palpate/base/error.hpp"
#include "palpate/servo/z_width.hpp"

namespace palpate::app {

namespace {

DeviceProfile find_profile(const ZWidthOptions& options) {
  const std::vector<DeviceProfile> among =
      options.profiles.empty() ? device_profiles() : read_device_profiles(options.profiles);
  return suggesting(options.profile, among, [&] { return device_profile(options.profile, among); });
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

// What was not found below the stiffest wall that is tried.
std::string stiffness(double newtons_per_metre) {
  if (newtons_per_metre >= kStiffestWall) return fmt::format("> {:.0f}", kStiffestWall);
  return fmt::format("{:.0f}", newtons_per_metre);
}

}  // namespace

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

std::string facts(const ZWidthMap& map) {
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
              {"rows", rows}}
      .dump(2);
}

}  // namespace palpate::app
