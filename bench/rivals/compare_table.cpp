// Writes the tables of compare_bench.
#include "rivals/compare_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "accuracy/strokes.hpp"
#include "accuracy/table.hpp"

namespace palpate::rivals {
namespace {

using accuracy::BenchResults;
using accuracy::Score;
using accuracy::Spread;

struct Metric {
  const char* title;
  double (*of)(const Score&);
  int digits;
  bool accuracy;  // of the forces, which is not known at the cloud's edge
};

constexpr std::array<Metric, 6> kMetrics = {
    Metric{"Angle of the force, degrees RMS", [](const Score& s) { return s.normal; }, 2, true},
    Metric{"Error of the force, N RMS", [](const Score& s) { return s.force; }, 3, true},
    Metric{"Contact lost, % of the time", [](const Score& s) { return 100 * s.lost; }, 1, true},
    Metric{"Pops: times that contact was lost for 3 ms", [](const Score& s) { return s.pops; }, 0,
           true},
    Metric{"Largest step of the force in a tick, N", [](const Score& s) { return s.step; }, 2,
           false},
    Metric{"Energy given to the hand, mJ", [](const Score& s) { return 1e3 * s.energy; }, 2,
           false}};

constexpr double kWithin = 1.1;  // derived: a tenth behind the first is still beside it
// Below these an error is nothing, whoever has less; derived: the last digit that a table shows
constexpr std::array<double, 2> kNothing = {0.01, 0.001};

std::vector<std::string> rows_of(const BenchResults& results, bool accuracy_rows) {
  std::vector<std::string> rows;
  for (const accuracy::Result& result : results.results) {
    if (accuracy_rows && accuracy::is_edge_row(result.row)) continue;
    if (std::ranges::count(rows, result.row) == 0) rows.push_back(result.row);
  }
  return rows;
}

Spread spread_of(const BenchResults& results, const std::string& method, const std::string& row,
                 const Metric& metric) {
  return accuracy::spread(results, method, {row, "", metric.of, {}, {}, ""});
}

// A method that has lost the surface has no angle and so no error: it is not the first of a row.
bool holds(const BenchResults& results, const std::string& method, const std::string& row) {
  return spread_of(results, method, row, kMetrics[2]).median < 50;
}

double best_of(const BenchResults& results, const std::vector<Method>& methods,
               const std::string& row, const Metric& metric, std::string* who = nullptr) {
  double best = std::numeric_limits<double>::infinity();
  for (const Method& method : methods) {
    const double median = spread_of(results, method.name, row, metric).median;
    if (median >= best || !holds(results, method.name, row)) continue;
    best = median;
    if (who != nullptr) *who = method.name;
  }
  return best;
}

std::string table(const BenchResults& results, const std::vector<Method>& methods,
                  const Metric& metric) {
  const std::vector<std::string> rows = rows_of(results, metric.accuracy);
  std::string text = fmt::format("{}:\n\n| |", metric.title);
  std::string rule = "|---|";
  std::vector<double> best;
  for (const std::string& row : rows) {
    text += fmt::format(" {} |", row);
    rule += "---|";
    best.push_back(best_of(results, methods, row, metric));
  }
  text += "\n" + rule + "\n";
  for (const Method& method : methods) {
    text += fmt::format("| {} |", method.name);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Spread s = spread_of(results, method.name, rows[i], metric);
      const bool first = metric.accuracy && s.median == best[i] && &metric - kMetrics.data() < 2;
      const char* bold = first ? "**" : "";
      text += fmt::format(" {}{:.{}f}{} ({:.{}f}) |", bold, s.median, metric.digits, bold, s.worst,
                          metric.digits);
    }
    text += "\n";
  }
  return text + "\n";
}

}  // namespace

std::string markdown_methods(const std::vector<Method>& methods) {
  std::string text =
      "| method | after | in a few words | its length | times |\n|---|---|---|---|---|\n";
  for (const Method& m : methods) {
    text += fmt::format("| {} | {} | {} | {} | {} |\n", m.name, m.after, m.rule, m.length,
                        *m.length == 0 ? "" : fmt::format("{:g}", m.scale));
  }
  return text;
}

std::string markdown_scores(const BenchResults& results, const std::vector<Method>& methods) {
  std::string text;
  for (const Metric& metric : kMetrics) text += table(results, methods, metric);
  return text;
}

std::string markdown_behind(const BenchResults& results, const std::vector<Method>& methods) {
  std::string text;
  for (std::size_t i = 0; i < kNothing.size(); ++i) {
    for (const std::string& row : rows_of(results, true)) {
      std::string who;
      const double best = best_of(results, methods, row, kMetrics[i], &who);
      const double ours = spread_of(results, "ours", row, kMetrics[i]).median;
      if (ours <= std::max(kWithin * best, best + kNothing[i])) continue;
      text += fmt::format("- {}, {}: ours {:.3f}, {} {:.3f}\n", row, kMetrics[i].title, ours, who,
                          best);
    }
  }
  return text.empty() ? "- none\n" : text;
}

std::string markdown_times(const std::vector<Times>& times, const std::vector<Method>& methods) {
  std::string text =
      "| method | preparation, ms a frame | step, us, p50 | p99 |\n|---|---|---|---|\n";
  for (const Method& method : methods) {
    std::vector<double> show, p50, p99;
    for (const Times& t : times) {
      if (t.method != method.name) continue;
      show.push_back(t.show);
      p50.push_back(t.p50);
      p99.push_back(t.p99);
    }
    text += fmt::format("| {} | {:.0f} | {:.1f} | {:.1f} |\n", method.name,
                        accuracy::spread(show).median, accuracy::spread(p50).median,
                        accuracy::spread(p99).median);
  }
  return text;
}

double mean_force_error(const BenchResults& results, const std::string& method) {
  const std::vector<std::string> rows = rows_of(results, true);
  double sum = 0;
  for (const std::string& row : rows) sum += spread_of(results, method, row, kMetrics[1]).median;
  return sum / static_cast<double>(rows.size());
}

}  // namespace palpate::rivals
