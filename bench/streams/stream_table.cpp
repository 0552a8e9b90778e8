// Prints table B and its targets.
#include "streams/stream_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate::streams {
namespace {

double jump(const Measures& m) {
  return m.jump;
}
double vibration(const Measures& m) {
  return m.vibration;
}
double ripple(const Measures& m) {
  return m.ripple;
}
double force(const Measures& m) {
  return m.force;
}
double normal_sd(const Measures& m) {
  return m.normal_sd;
}
double lag(const Measures& m) {
  return m.lag;
}
double lag_sd(const Measures& m) {
  return m.lag_sd;
}
double lost(const Measures& m) {
  return 100 * (1 - m.contact);
}
double pops(const Measures& m) {
  return m.pops;
}
double step(const Measures& m) {
  return m.step;
}

constexpr const char* kJump = "jump, N rms";
constexpr const char* kVibration = "vibration, N rms";
constexpr const char* kLag = "lag, mm";
constexpr const char* kLagSd = "its sd, mm";
constexpr const char* kLost = "contact lost, %";

// Two significant digits.
std::string number(double value) {
  if (value == 0) return "0";
  const int digits = 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  return fmt::format("{:.{}f}", value, std::clamp(digits, 0, 6));
}

}  // namespace

std::vector<Target> targets() {
  return {
      {"static press, noise a", kJump, jump, 0.001, "0.035-0.087 (p95)", "0.015, patched"},
      {"static press, noise a", kVibration, vibration, 0.0005, "0.0141, 0.0057", ""},
      {"static press, noise c", kVibration, vibration, 0.002, "0.028, 0.023", ""},
      {"irregular frames, press", kJump, jump, 0.001, "", ""},
      {"irregular frames, press", kVibration, vibration, 0.0005, "", ""},
      {"sphere slide", "force, N", force, 0.08, "", ""},
      {"sphere slide", "ripple, N", ripple, 0.003, "", ""},
      {"sphere slide", kJump, jump, 0.003, "", ""},
      {"plane comes at 10 cm/s", kLag, lag, 3.5, "4.1-7.0", ""},
      {"plane comes at 10 cm/s", kLagSd, lag_sd, 0.1, "1.0", ""},
      {"plane comes at 10 cm/s", kLost, lost, 0, "at R = 6 mm: lost", ""},
      {"ball comes at 10 cm/s", kLost, lost, 0, "", ""},
      {"plane comes at 2 cm/s", kLag, lag, 0.75, "1.35-1.6", ""},
      {"plane comes at 2 cm/s", kLost, lost, 0, "", ""},
      {"ball comes at 2 cm/s", kLag, lag, 0.75, "", ""},
      {"ball comes at 2 cm/s", kLost, lost, 0, "", ""},
      {"the setting of Fig. 7", "sd of normal, deg", normal_sd, 0.3,
       "metaball 8.6-3.9, pointset 4.4-1.75", "0.16-19"},
      {"camera moves", kLost, lost, 0, "", ""},
      {"camera moves", kVibration, vibration, 0.01, "", ""},
      {"two cameras, table", "pops", pops, 0, "", ""},
      {"two cameras, table", "largest step, N", step, 0.3, "", ""},
      {"two cameras, sphere", "pops", pops, 0, "", ""},
      {"two cameras, sphere", "largest step, N", step, 0.3, "", ""},
  };
}

std::vector<double> values(const std::vector<Result>& results, const Target& target) {
  for (const Result& result : results) {
    if (result.experiment == target.experiment && result.contender == "default") {
      return {target.of(result.measures)};
    }
  }
  return {};
}

std::string markdown_targets(const std::vector<Result>& results) {
  std::string text =
      "| stream | metric | palpate's default | target | the paper's way (quoted) | CHAI3D (quoted) "
      "|\n|---|---|---|---|---|---|\n";
  for (const Target& target : targets()) {
    for (const double value : values(results, target)) {
      const char* mark = std::abs(value) <= target.limit ? "" : " **missed**";
      text += fmt::format("| {} | {} | {}{} | {:g} | {} | {} |\n", target.experiment, target.metric,
                          number(value), mark, target.limit, target.paper, target.chai3d);
    }
  }
  return text;
}

std::string markdown_experiment(const std::vector<Result>& results) {
  std::string text =
      "| in time | surface | R, mm | jump, N rms (p95) | vibration, N | force error, N | sd of "
      "normal, deg "
      "| under the surface, mm | contact, % | largest step, N "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Result& result : results) {
    const Measures& m = result.measures;
    text += fmt::format(
        "| {} | {} | {} | {} ({}) | {} | {} | {} | {} +- {} | {:.1f} | {} |\n", result.contender,
        result.tool, m.radius > 0 ? fmt::format("{:.1f}", m.radius) : "", number(m.jump),
        number(m.jump_high), number(m.vibration), m.force > 0 ? number(m.force) : "",
        number(m.normal_sd), number(m.lag), number(m.lag_sd), 100 * m.contact, number(m.step));
  }
  return text;
}

}  // namespace palpate::streams
