#include "apps/palpate/doctor/jitter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "apps/palpate/cli/words.hpp"
#include "apps/palpate/doctor/kernel.hpp"
#include "apps/palpate/doctor/rights.hpp"

namespace palpate::app::doctor {

namespace {

constexpr double kPeriod = 1e-3;       // s
constexpr double kFirstBin = 1.25e-7;  // s, the lower end of a Durations' first bin
constexpr double kWidest = 40;         // characters of the longest bar

// One row an octave, from the first that holds a step to the last.
std::vector<std::string> histogram(const Durations& lateness) {
  std::vector<std::uint64_t> rows;
  for (std::size_t bin = 0; bin < Durations::kBins; bin += Durations::kPerOctave) {
    const auto octave = std::span(lateness.counts).subspan(bin, Durations::kPerOctave);
    rows.push_back(std::accumulate(octave.begin(), octave.end(), std::uint64_t{0}));
  }
  const auto holds = [](std::uint64_t steps) { return steps > 0; };
  const auto first = std::ranges::find_if(rows, holds);
  const auto last = std::find_if(rows.rbegin(), rows.rend(), holds).base();
  const auto most = static_cast<double>(*std::ranges::max_element(rows));
  std::vector<std::string> lines;
  for (auto row = first; row < last; ++row) {
    const double upper = kFirstBin * std::exp2(1 + std::distance(rows.begin(), row));
    const double bar = std::ceil(kWidest * static_cast<double>(*row) / most);
    lines.push_back(fmt::format("{:>12} {:>8}{}{}", "< " + duration(upper), grouped(*row),
                                *row > 0 ? " " : "",
                                std::string(static_cast<std::size_t>(bar), '#')));
  }
  return lines;
}

bool is_virtual(const System& system) {
  return text(system, "proc/cpuinfo").value_or("").find(" hypervisor") != std::string::npos;
}

}  // namespace

Finding check_jitter(const System& system, const RealtimeTrial& trial) {
  const Durations& lateness = trial.lateness;
  Finding finding{"kernel", "jitter at 1 kHz"};
  finding.words = fmt::format("{} steps were late by {} (median), {} (99.9 %), {} (longest)",
                              grouped(lateness.count), duration(lateness.quantile(0.5)),
                              duration(lateness.quantile(0.999)), duration(lateness.longest));
  finding.lines = histogram(lateness);
  if (trial.left_out == 0 && lateness.longest < kPeriod) return finding;
  finding.severity = lateness.quantile(0.999) < kPeriod ? Severity::note : Severity::warning;
  finding.words += fmt::format("; left out: {}", grouped(trial.left_out));
  if (is_virtual(system)) finding.words += "; this is a virtual machine, whose host may halt it";
  if (!trial.report.all_granted()) {
    finding.remedy = rights_command(system);
  } else if (check_preemption(system).severity != Severity::good) {
    finding.remedy = realtime_kernel_command(system);
  } else {
    finding.remedy = "top -b -n 1 | head -n 15";
  }
  return finding;
}

}  // namespace palpate::app::doctor
