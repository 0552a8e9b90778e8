#include "apps/palpate/report/live_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app {

namespace {

// "slowed 12 steps, shortened 3"; empty: it let everything pass.
std::string guard_words(const GuardCounts& counts) {
  std::string words;
  const auto add = [&words](std::uint64_t count, std::string_view text) {
    if (count == 0) return;
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", grouped(count), text);
  };
  add(counts.slewed, "steps slowed that the hand did not cause");
  add(counts.clamped, "steps shortened");
  add(counts.braked, "braked, for the hand had been given energy");
  add(counts.starting, "within a soft start");
  add(counts.softened, "softer than asked for, as the device bears no more");
  add(counts.silences, "silences ended by zero force");
  add(counts.faults, "faults");
  return words;
}

void print_guard(const LiveReport& report, const Style& style, std::FILE* out) {
  const GuardState& guard = report.guard;
  const std::string words = guard_words(guard.counts);
  const GuardOptions& limits = report.limits;
  const std::string most = std::isfinite(limits.maximum_force)
                               ? fmt::format("{:.3g} N at most", limits.maximum_force)
                               : "any force";
  fmt::print(out, "  guard      {}, {:.3g} N/s, watchdog {}: {}\n", most, limits.slew,
             duration(limits.silence), words.empty() ? "let every force pass" : words);
  if (guard.fault == GuardFault::none) return;
  fmt::print(out, "  {} {}\n", style.warning("fault     "), in_words(guard.fault));
}

void print_requests(const RealtimeReport& report, const Style& style, std::FILE* out) {
  for (const RealtimeRequest& request : report.requests) {
    if (request.granted) {
      fmt::print(out, "  real time  {}: granted\n", request.what);
    } else {
      fmt::print(out, "  {} {}: not granted: {}\n", style.warning("real time "), request.what,
                 request.remedy);
    }
  }
}

// JSON has no infinity: null is no limit.
Json limit(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json json_requests(const RealtimeReport& report) {
  Json requests = Json::array();
  for (const RealtimeRequest& request : report.requests) {
    requests.push_back(
        {{"what", request.what}, {"granted", request.granted}, {"remedy", request.remedy}});
  }
  return requests;
}

}  // namespace

void print_live(const LiveReport& report, std::FILE* out) {
  const Style style(out);
  const Durations& late = report.lateness;
  fmt::print(out,
             "  pace       {:.4g} Hz; late by {} (p50), {} (p99), {} (max); steps left out: {}\n",
             report.rate, duration(late.quantile(0.5)), duration(late.quantile(0.99)),
             duration(late.longest), report.skipped == 0 ? "none" : grouped(report.skipped));
  if (report.unwritten > 0) {
    fmt::print(out, "  {} {} steps came too fast to be written down; they are in no log\n",
               style.warning("unwritten "), grouped(report.unwritten));
  }
  print_guard(report, style, out);
  print_requests(report.realtime, style, out);
  if (!report.failure.empty()) {
    fmt::print(out, "  {} {}\n", style.error("FAILED    "), report.failure);
  }
}

Json json_live(const LiveReport& report) {
  const Durations& late = report.lateness;
  const GuardCounts& counts = report.guard.counts;
  return {{"rate_Hz", report.rate},
          {"late_s",
           {{"p50", late.quantile(0.5)}, {"p99", late.quantile(0.99)}, {"max", late.longest}}},
          {"steps_left_out", report.skipped},
          {"steps_unwritten", report.unwritten},
          {"guard",
           {{"maximum_force_N", limit(report.limits.maximum_force)},
            {"slew_N_per_s", report.limits.slew},
            {"watchdog_s", report.limits.silence},
            {"damping_Ns_per_m", report.limits.damping},
            {"soft_start_s", report.limits.soft_start},
            {"passivity", report.limits.passivity.on},
            {"slewed", counts.slewed},
            {"clamped", counts.clamped},
            {"braked", counts.braked},
            {"starting", counts.starting},
            {"softened", counts.softened},
            {"silences", counts.silences},
            {"faults", counts.faults},
            {"fault", std::string(in_words(report.guard.fault))}}},
          {"realtime", json_requests(report.realtime)},
          {"failure", report.failure}};
}

}  // namespace palpate::app
