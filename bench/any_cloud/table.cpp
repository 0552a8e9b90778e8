// Writes the scores as a table and as comma-separated values.
#include "any_cloud/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::any_cloud {
namespace {

struct Metric {
  const char* name;
  double Score::*value;
  int width;  // of one number in the table; 0: in the file alone
  int digits;
  bool median;      // beside the worst
  double best = 0;  // the worst is farthest from it
};

constexpr std::array kMetrics{
    Metric{"dF", &Score::force_error, 5, 2, true},
    Metric{"ratio", &Score::force_ratio, 4, 2, true, 1},
    Metric{"step", &Score::step, 5, 2, true},
    Metric{"ideal", &Score::ideal_step, 5, 2, false},
    Metric{"lost", &Score::lost, 5, 1, true},
    Metric{"thru", &Score::through, 4, 0, false},
    Metric{"free", &Score::in_free_air, 5, 0, false},
    Metric{"side", &Score::wrong_side, 5, 0, false},
    Metric{"h", &Score::height, 5, 3, true},
    Metric{"hmax", &Score::highest, 5, 2, false},
    Metric{"pokes", &Score::pokes, 5, 0, false},
    Metric{"pass", &Score::passed, 4, 0, false},
    Metric{"held", &Score::held, 4, 0, false},
    Metric{"outN", &Score::most_outside, 5, 2, false},
    Metric{"over", &Score::over, 5, 2, false},
    Metric{"in", &Score::within, 5, 0, false},
    Metric{"caught", &Score::caught, 6, 0, false},
    Metric{"mJ", &Score::energy, 5, 2, false},
    Metric{"nan", &Score::faults, 3, 0, false},
    Metric{"us", &Score::usual_us, 4, 0, false},
    Metric{"us999", &Score::slow_us, 5, 0, false},
    Metric{"usmax", &Score::slowest_us, 5, 0, false},
    Metric{"R", &Score::radius, 4, 1, false},
    Metric{"Rmax", &Score::radius_largest, 5, 1, false},
    Metric{"sigma", &Score::noise, 5, 2, false},
    Metric{"ideal_off", &Score::ideal_off, 0, 0, false},
};

struct Spread {
  double median = 0;
  double worst = 0;
};

Spread spread(const std::vector<Result>& seeds, const Metric& metric) {
  std::vector<double> values;
  for (const Result& result : seeds) {
    const double value = result.score ? (*result.score).*metric.value : std::nan("");
    if (!std::isnan(value)) values.push_back(value);
  }
  if (values.empty()) return {std::nan(""), std::nan("")};
  std::sort(values.begin(), values.end());
  const bool low = metric.best - values.front() > values.back() - metric.best;
  return {values[values.size() / 2], low ? values.front() : values.back()};
}

std::string number(double value, const Metric& metric) {
  if (std::isnan(value)) return fmt::format("{:>{}}", "-", metric.width);
  return fmt::format("{:{}.{}f}", value, metric.width, metric.digits);
}

}  // namespace

std::string legend() {
  return "Medians and worst over the seeds, or worst alone. Lengths in spacings (s). dF: force "
         "error, RMS, N.\nratio: force to the ideal's. step, ideal: largest step of force beyond "
         "K v dt, N. lost: % of required\ncontact. thru: pushes that went through. free: ticks "
         "with force in free air. side: ticks with force\nthe other way. h: mean distance "
         "of the proxy from the surface. pokes: in which contact is\nrequired, pass: that went "
         "through the surface, held: by the body, 8 spacings outside, outN: there by so much "
         "at\nmost, over: % of ticks above 1.3 of the ideal force. in: ticks with a proxy inside "
         "the solid or a force into it, caught: with force where proxy and hand share free space. "
         "mJ: given to the hand. us: a "
         "step.\n";
}

std::string header() {
  std::string text = fmt::format("{:<30}", "row");
  for (const Metric& metric : kMetrics) {
    if (metric.width == 0) continue;
    const int width = metric.median ? 2 * metric.width + 1 : metric.width;
    text += fmt::format(" {:>{}}", metric.name, width);
  }
  return text + "\n";
}

std::string table_line(const std::vector<Result>& seeds) {
  std::string text = fmt::format("{:<30}", seeds.front().row);
  for (const Metric& metric : kMetrics) {
    if (metric.width == 0) continue;
    const Spread values = spread(seeds, metric);
    if (metric.median) text += " " + number(values.median, metric);
    text += (metric.median ? "/" : " ") + number(values.worst, metric);
  }
  for (const Result& result : seeds) {
    if (!result.score)
      return text + fmt::format(" REFUSED seed {}: {}\n", result.seed, result.refusal);
    if (result.score->ideal_off > 0) {
      return text + fmt::format(" IDEAL OFF {:.0f} ticks, seed {}\n", result.score->ideal_off,
                                result.seed);
    }
  }
  return text + "\n";
}

std::string csv(const std::vector<Result>& results) {
  std::string text = "row,seed";
  for (const Metric& metric : kMetrics) text += fmt::format(",{}", metric.name);
  text += ",refusal\n";
  for (const Result& result : results) {
    text += fmt::format("{},{}", result.row, result.seed);
    for (const Metric& metric : kMetrics) {
      text += result.score ? fmt::format(",{:.6g}", (*result.score).*metric.value) : ",";
    }
    text += "," + result.refusal + "\n";
  }
  return text;
}

}  // namespace palpate::any_cloud
