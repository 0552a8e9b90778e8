// Writes the table of drawn layouts and its targets.
#include "accuracy/drawn_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "accuracy/strokes.hpp"

namespace palpate::accuracy {
namespace {

struct Metric {
  double (*of)(const Score&);
  Limit DrawnLimits::*limit;
  int digits;
};

constexpr std::array<Metric, 3> kMetrics = {
    Metric{[](const Score& s) { return s.normal; }, &DrawnLimits::normal, 2},
    Metric{[](const Score& s) { return s.force; }, &DrawnLimits::force, 3},
    Metric{[](const Score& s) { return 100 * s.lost; }, &DrawnLimits::lost, 1}};

std::vector<std::string> rows_of(const BenchResults& results) {
  std::vector<std::string> rows;
  for (const Result& result : results.results) {
    if (is_edge_row(result.row)) continue;
    if (std::find(rows.begin(), rows.end(), result.row) == rows.end()) rows.push_back(result.row);
  }
  return rows;
}

Target metric_of_row(const std::string& row, const Metric& metric) {
  return {row, "", metric.of, {}, {}, ""};
}

void join(std::string& text, const std::string& part) {
  text += text.empty() ? part : " / " + part;
}

std::string targets_cell(const DrawnLimits& limits) {
  std::string text;
  for (const Metric& metric : kMetrics) join(text, limit_text(limits.*metric.limit, "-"));
  return text;
}

std::string values_cell(const BenchResults& results, const std::string& contender,
                        const std::string& row) {
  std::string text;
  for (const Metric& metric : kMetrics) {
    const Spread s = spread(results, contender, metric_of_row(row, metric));
    join(text, fmt::format("{:.{}f} ({:.{}f})", s.median, metric.digits, s.worst, metric.digits));
  }
  return text;
}

std::string shares_cell(const BenchResults& results, const std::string& contender,
                        const std::string& row, const DrawnLimits& limits) {
  std::string text;
  for (const Metric& metric : kMetrics) {
    const double bound = (limits.*metric.limit).median;
    const double share = share_above(results, contender, metric_of_row(row, metric), bound);
    join(text, bound < 0 ? "-" : fmt::format("{:.0f}", share));
  }
  return text;
}

}  // namespace

DrawnLimits drawn_limits(NoiseKind noise, const std::string& row) {
  const bool independent = noise == NoiseKind::independent;
  const bool blurred = noise == NoiseKind::blurred;
  DrawnLimits limits;
  if (row == "crease 3 mm" || row == "crease 10 mm") {
    limits.force = {0.2};
    limits.lost = independent ? Limit{0} : Limit{0, 5};
  }
  if (row == "fast tap" && (independent || blurred)) limits.force = {0.11};
  if (row == "thin push" && (independent || blurred)) limits.force = {0.2};
  if (row == "plane slide" && independent) limits = {{0.1, 0.15}, {0.012}, {}};
  if (row == "plane slide" && blurred) limits.normal = {0.5, 0.8};
  if (row == "sphere slide" && independent) limits = {{1.5, 2.0}, {0.07, 0.1}, {}};
  if (row == "sphere slide" && blurred) limits.normal = {2.3, 3.0};
  if (row == "box edge" && independent) limits = {{5, 8}, {0.13}, {0.5}};
  return limits;
}

double share_above(const BenchResults& results, const std::string& contender, const Target& target,
                   double value) {
  double frames = 0;
  double above = 0;
  for (const Result& result : results.results) {
    if (result.contender != contender || result.row != target.row) continue;
    ++frames;
    if (std::abs(target.of(result.score)) > value) ++above;
  }
  return frames > 0 ? 100 * above / frames : 0;
}

std::string markdown_drawn(const BenchResults& results, const std::vector<Contender>& contenders,
                           NoiseKind noise) {
  std::string text = "| normal deg / force N / lost % | target |";
  std::string rule = "|---|---|";
  for (const Contender& contender : contenders) {
    text += fmt::format(" {} | above, % |", contender.name);
    rule += "---|---|";
  }
  text += "\n" + rule + "\n";
  for (const std::string& row : rows_of(results)) {
    const DrawnLimits limits = drawn_limits(noise, row);
    text += fmt::format("| {} | {} |", row, targets_cell(limits));
    for (const Contender& contender : contenders) {
      text += fmt::format(" {} | {} |", values_cell(results, contender.name, row),
                          shares_cell(results, contender.name, row, limits));
    }
    text += "\n";
  }
  return text;
}

}  // namespace palpate::accuracy
