#include "apps/palpate/zwidth/zwidth_report.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/words.hpp"
#include "palpate/servo/z_width.hpp"

namespace palpate::app {

namespace {

// What was not found below the stiffest wall that is tried.
std::string stiffness(double newtons_per_metre) {
  if (newtons_per_metre >= kStiffestWall) return fmt::format("> {:.0f}", kStiffestWall);
  return fmt::format("{:.0f}", newtons_per_metre);
}

}  // namespace

void print_zwidth(const ZWidthMap& map, std::FILE* out) {
  const Style style(out);
  fmt::print(out, "{} {}: how stiff a wall may be, N/m\n", style.heading("z-width"),
             map.profile.title);
  fmt::print(out,
             "simulated with {:.3g} kg, dry friction {:.3g} N, places in steps of {}, wall damper "
             "{:.3g} N s/m\n",
             map.mass, map.coulomb, length(map.resolution), map.wall_damping);
  fmt::print(out, "{:>8} {:>6} {:>9} {:>9} {:>9} {:>9} {:>11}\n", "rate", "delay", "damping",
             "Colgate", "stable", "passive", "with brake");
  for (const ZWidthRow& row : map.rows) {
    fmt::print(out, "{:>5.0f} Hz {:>6} {:>9.3g} {:>9.0f} {:>9} {:>9} {:>11}\n", row.rate, row.delay,
               row.damping, row.colgate, stiffness(row.stable), stiffness(row.passive),
               stiffness(row.braked));
  }
  fmt::print(
      out,
      "delay: steps from a place to its force; damping: of the device, N s/m\n"
      "Colgate: 2 (b + B) / (T + 2 T_d); stable: oscillations of a device that nobody holds "
      "do not grow;\npassive: it leaves the wall no faster than it came; with brake: likewise, "
      "with the guard's passivity controller\n");
  if (map.profile.damping && map.profile.mass) return;
  fmt::print(out,
             "{} mass or friction of this device are not known and are assumed: a map to look up, "
             "not a measurement of yours\n",
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
