// Writes table A as Markdown and as comma-separated values.
#include "accuracy/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate::accuracy {
namespace {

std::vector<double> values_of(const BenchResults& results, const std::string& contender,
                              const Target& target) {
  std::vector<double> values;
  for (const Result& result : results.results) {
    if (result.contender == contender && result.row == target.row) {
      values.push_back(target.of(result.score));
    }
  }
  return values;
}

// Three significant digits, never an exponent.
std::string number(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size < 0.01) return fmt::format("{:.4f}", value);
  if (size < 1) return fmt::format("{:.3f}", value);
  return fmt::format("{:.2f}", value);
}

std::string cell(const BenchResults& results, const std::string& contender, const Target& target) {
  const Spread s = spread(results, contender, target);
  const char* mark = met(results, contender, target) ? "" : " **missed**";
  return fmt::format("{} ({}){}", number(s.median), number(s.worst), mark);
}

bool has_row(const BenchResults& results, const std::string& row) {
  return std::any_of(results.results.begin(), results.results.end(),
                     [&](const Result& result) { return result.row == row; });
}

char letter(NoiseKind noise) {
  if (noise == NoiseKind::none) return '-';
  if (noise == NoiseKind::independent) return 'a';
  return noise == NoiseKind::blurred ? 'b' : 'c';
}

}  // namespace

Limit limit_of(const Target& target, const std::string& contender) {
  if (contender == kOrganised) return target.organised;
  return contender == kUnorganised ? target.points : Limit{};
}

std::string limit_text(const Limit& limit, const char* none) {
  if (limit.median < 0) return none;
  if (limit.worst < 0) return fmt::format("{:g}", limit.median);
  return fmt::format("{:g} ({:g})", limit.median, limit.worst);
}

Spread spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median =
      values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return {median,
          std::abs(values.front()) > std::abs(values.back()) ? values.front() : values.back()};
}

Spread spread(const BenchResults& results, const std::string& contender, const Target& target) {
  return spread(values_of(results, contender, target));
}

bool met(const BenchResults& results, const std::string& contender, const Target& target) {
  const Limit limit = limit_of(target, contender);
  const Spread s = spread(results, contender, target);
  return (limit.median < 0 || std::abs(s.median) <= limit.median) &&
         (limit.worst < 0 || std::abs(s.worst) <= limit.worst);
}

std::string markdown_table(const BenchResults& results, const std::vector<Contender>& contenders,
                           const BenchOptions& options) {
  std::string text = "| row | metric | target, organised | target, points |";
  for (const Contender& contender : contenders) text += fmt::format(" {} |", contender.name);
  text += " CHAI3D (quoted) |\n|---|---|---|---|";
  for (std::size_t i = 0; i <= contenders.size(); ++i) text += "---|";
  text += "\n";
  for (const Target& target : targets(options.noise)) {
    if (!has_row(results, target.row)) continue;
    text += fmt::format("| {} | {} | {} | {} |", target.row, target.metric,
                        limit_text(target.organised, ""), limit_text(target.points, ""));
    for (const Contender& contender : contenders) {
      text += fmt::format(" {} |", cell(results, contender.name, target));
    }
    text += fmt::format(" {} |\n", target.quoted);
  }
  return text;
}

std::string markdown_preparation(const BenchResults& results) {
  std::string text =
      "| prepared for | points | spacing, mm | noise, mm | voxel, mm | R, mm (smallest-largest) |\n"
      "|---|---|---|---|---|---|\n";
  for (const Preparation& prepared : results.preparations) {
    const Prepared::Report& r = prepared.report;
    if (prepared.seed != results.preparations.front().seed) break;
    if (r.points_out == 0) {  // a depth frame
      const Source::State& s = prepared.state;
      text += fmt::format("| {} | {} | | {:.2f} at {:.2f} m, correlation {:.2f} | | |\n",
                          prepared.contender, s.points, 1e3 * s.noise, s.depth, s.correlation);
      continue;
    }
    text +=
        fmt::format("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.1f} ({:.1f}-{:.1f}) |\n",
                    prepared.contender, r.points_out, 1e3 * r.spacing, 1e3 * r.noise, 1e3 * r.voxel,
                    1e3 * r.radius, 1e3 * r.radius_smallest, 1e3 * r.radius_largest);
  }
  return text;
}

std::string csv_header() {
  return "layout,noise,seed,field,row,normal_deg,force_N,ripple_N,height_mm,lost,pops,"
         "step_N,peak_N,energy_J\n";
}

std::string csv(const BenchResults& results, const BenchOptions& options) {
  std::string text;
  for (const Result& r : results.results) {
    const Score& s = r.score;
    text +=
        fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:g},{:.6g},{:.6g},{:.6g}\n",
                    r.layout, letter(options.noise), r.seed, r.contender, r.row, s.normal, s.force,
                    s.ripple, s.height, s.lost, s.pops, s.step, s.peak, s.energy);
  }
  return text;
}

}  // namespace palpate::accuracy
