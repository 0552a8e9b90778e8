#include "apps/palpate/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/source_options.hpp"

namespace palpate::app {

void Report::print(std::FILE* out) const {
  const Style style(out);
  fmt::print(out, "{}{}{}\n", style.heading(without_controls(title_)), rest_.empty() ? "" : " ",
             without_controls(rest_));
  for (const Line& line : lines_) {
    std::string label = fmt::format("{:<10}", line.label);
    if (line.mark == Mark::warning) label = style.warning(label);
    if (line.mark == Mark::error) label = style.error(label);
    fmt::print(out, "  {} {}\n", label, without_controls(line.text));
  }
}

std::string and_some(std::size_t count, const char* words) {
  return count == 0 ? "" : fmt::format(", {} {}", grouped(count), words);
}

Json limit(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

namespace {

// What is said of a phase at the end of a run.
std::string_view phase_words(StreamState::Phase phase) {
  if (phase == StreamState::Phase::starting) return "no frame arrived";
  if (phase == StreamState::Phase::ended) return "ended; its last surface was kept";
  return name_of(phase);
}

// A cause for which frames are dropped: its name in data, and what is said of it.
struct DropText {
  std::uint64_t StreamState::Drops::*count;
  const char* name;
  const char* words;
};

constexpr std::array<DropText, 8> kDrops = {
    {{&StreamState::Drops::overtaken, "overtaken", "overtaken"},
     {&StreamState::Drops::repeated, "repeated", "repeated"},
     {&StreamState::Drops::late, "late", "late"},
     {&StreamState::Drops::empty, "empty", "empty"},
     {&StreamState::Drops::garbage, "garbage", "garbage"},
     {&StreamState::Drops::unposed, "unposed", "without a pose"},
     {&StreamState::Drops::resized, "resized", "of a different size"},
     {&StreamState::Drops::refused, "refused", "refused"}}};

// "overtaken 3, late 1".
std::string drop_words(const StreamState::Drops& drops) {
  std::string words;
  for (const DropText& each : kDrops) {
    const std::uint64_t count = drops.*each.count;
    if (count > 0) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, each.words);
  }
  return words.empty() ? "none" : words;
}

Json json_drops(const StreamState::Drops& drops) {
  Json json;
  for (const DropText& each : kDrops) json[each.name] = drops.*each.count;
  return json;
}

// Of the preparation of a frame, ms.
struct Quantiles {
  double p50 = 0;
  double p99 = 0;
  double most = 0;
};

Quantiles quantiles_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {quantile(values, 0.5), quantile(values, 0.99), quantile(values, 1)};
}

// The share of frames of a run in simulated time that live would have been overtaken while others
// were prepared; 0 for a run that was live.
double share_too_fast(const FeedReport& feed, const Quantiles& times) {
  if (!feed.simulated || !(times.p50 > 0) || !(feed.state.rate > 0)) return 0;
  return std::max(0.0, 1 - 1e3 / (times.p50 * feed.state.rate));
}

std::string range(double smallest, double middle, double largest) {
  if (largest <= 1.001 * smallest) return length(middle);
  return fmt::format("{} ({} to {})", length(middle), length(smallest), length(largest));
}

Report file_report(const LoadedSource& source) {
  const CloudArgument& argument = source.plan.argument;
  Report report(argument.name, fmt::format("{} ({})", argument.path, source.format));
  report.data = {{"name", argument.name}, {"file", argument.path}, {"format", source.format}};
  return report;
}

void add_times(Report& report, const LoadedSource& cloud) {
  const Prepared::Report& r = cloud.prepared;
  report.line("prepared",
              fmt::format("{} after {} of reading: filter {}, index {}, spacing {}, normals {}, "
                          "weights {}",
                          duration(cloud.prepare_seconds), duration(cloud.read_seconds),
                          duration(r.seconds_filter), duration(r.seconds_index),
                          duration(r.seconds_spacing), duration(r.seconds_normals),
                          duration(r.seconds_weights)));
  report.data["seconds"] = {{"read", cloud.read_seconds},   {"prepare", cloud.prepare_seconds},
                            {"filter", r.seconds_filter},   {"index", r.seconds_index},
                            {"spacing", r.seconds_spacing}, {"normals", r.seconds_normals},
                            {"weights", r.seconds_weights}};
}

Report cloud_report(const LoadedSource& cloud) {
  const Prepared::Report& r = cloud.prepared;
  Report report = file_report(cloud);
  report.line("points", fmt::format("{} read, {} felt{}{}{}", grouped(r.points_in),
                                    grouped(r.points_out), and_some(r.duplicates, "duplicates"),
                                    and_some(r.speckle, "dropped as speckle"),
                                    and_some(cloud.dropped, "invalid")));
  report.data.update({{"points_declared", cloud.declared},
                      {"points_invalid", cloud.dropped},
                      {"points_read", r.points_in},
                      {"points_felt", r.points_out},
                      {"points_duplicate", r.duplicates},
                      {"points_speckle", r.speckle}});
  if (!cloud.units.advice.empty()) {
    report.line(
        "units",
        fmt::format("{}? {}; {}", cloud.units.units, cloud.units.reason, cloud.units.advice),
        Mark::warning);
  }
  report.line("spacing", fmt::format("{}, noise {}, voxel {}", length(r.spacing), length(r.noise),
                                     r.voxel > 0 ? length(r.voxel) : "none"));
  report.line("R", range(r.radius_smallest, r.radius, r.radius_largest));
  report.data.update(
      {{"spacing_m", r.spacing},
       {"noise_m", r.noise},
       {"voxel_m", r.voxel},
       {"radius_m",
        {{"median", r.radius}, {"smallest", r.radius_smallest}, {"largest", r.radius_largest}}}});
  add_trust(report, r);
  add_times(report, cloud);
  return report;
}

void add_seen(Report& report, const Source::State& state) {
  report.line(
      "points",
      fmt::format("{} felt", grouped(state.points)) +
          (state.depth > 0 ? fmt::format(", image centre {} away", length(state.depth)) : ""));
  if (state.depth > 0) {
    report.line("noise", fmt::format("{} per pixel there", length(state.noise)) +
                             (state.correlation > 1.01
                                  ? fmt::format(", correlation {:.2f} (1: independent pixels)",
                                                state.correlation)
                                  : ""));
  }
  report.data.update({{"points_felt", state.points},
                      {"depth_m", state.depth},
                      {"noise_m", state.noise},
                      {"noise_correlation", state.correlation}});
  if (!state.disagreement) return;
  report.line("disagrees", fmt::format("{} with the other sources where both see a surface",
                                       length(*state.disagreement)));
  report.data["disagreement_m"] = *state.disagreement;
}

Report image_report(const LoadedSource& source) {
  Report report = file_report(source);
  report.data["seconds"] = {{"read", source.read_seconds}, {"prepare", source.prepare_seconds}};
  if (source.lens.width > 0) {
    report.line("organised", fmt::format("{}, processed as a depth frame", in_words(source.lens)));
    report.data["organised"] = json_of(source.lens);
  }
  add_seen(report, source.state);
  report.line("prepared", fmt::format("{} after {} of reading", duration(source.prepare_seconds),
                                      duration(source.read_seconds)));
  return report;
}

void add_frames(Report& report, const FeedReport& feed) {
  const StreamState& state = feed.state;
  report.line("frames",
              fmt::format("{} of {} touchable, {:.1f} Hz; dropped: {}", grouped(state.touchable),
                          grouped(state.frames), state.rate, drop_words(state.drops)));
  report.data.update({{"width", feed.width},
                      {"height", feed.height},
                      {"phase", name_of(state.phase)},
                      {"frames", state.frames},
                      {"frames_touchable", state.touchable},
                      {"rate_Hz", state.rate},
                      {"drops", json_drops(state.drops)},
                      {"failures", state.failures},
                      {"stalls", state.stalls},
                      {"problem", state.problem}});
}

void add_latency(Report& report, const FeedReport& feed) {
  const StreamState& state = feed.state;
  const Quantiles latency = quantiles_of(feed.latency_s);
  const Quantiles times = quantiles_of(feed.prepare_ms);
  const double dropped = share_too_fast(feed, times);
  report.line(
      "latency",
      fmt::format("{} (p50), {} (p99), {} (max) from frame to touchable; preparation {} (p50), "
                  "{} (max)",
                  duration(latency.p50), duration(latency.p99), duration(latency.most),
                  duration(1e-3 * times.p50), duration(1e-3 * times.most)));
  if (dropped > 0) {
    report.line("too slow",
                fmt::format("preparing a frame takes {}, but frames arrive every {}: live, {:.0f} "
                            "% would be dropped",
                            duration(1e-3 * times.p50), duration(1 / state.rate),
                            std::min(99.0, std::ceil(100 * dropped))),
                Mark::warning);
  }
  report.data.update(
      {{"latency_s", {{"p50", latency.p50}, {"p99", latency.p99}, {"max", latency.most}}},
       {"prepare_ms", {{"p50", times.p50}, {"max", times.most}}},
       {"would_drop_live", dropped}});
}

void add_policy(Report& report, const SourcePlan& plan) {
  const Policy policy = policy_of(plan);
  std::string words = name_in(kPolicies, policy);
  report.data["policy"] = {{"name", words}};
  if (keeps_history(policy)) {
    words += fmt::format(" of {}", plan.options.policy.history);
    report.data["policy"]["history"] = plan.options.policy.history;
  }
  report.line("policy", words);
}

}  // namespace

Report camera_report(const LoadedSource& source) {
  const CloudArgument& argument = source.plan.argument;
  const FeedReport& feed = source.feed;
  const StreamState& state = feed.state;
  const std::string size =
      feed.width > 0 ? fmt::format("{} x {} pixels", feed.width, feed.height) : "clouds";
  Report report(argument.name,
                fmt::format("{} ({}), {}", argument.path, size, phase_words(state.phase)));
  report.data = {{"name", argument.name}, {"camera", argument.path}};
  const std::string assumed = source.camera ? source.camera->info().assumed : "";
  if (!assumed.empty()) report.line("assumed", assumed);
  add_frames(report, feed);
  add_latency(report, feed);
  add_policy(report, source.plan);
  add_seen(report, source.state);
  if (state.problem.empty()) return report;
  report.line("problem",
              fmt::format("{} (at {:.3f} s; {} failed reads, stalled {} times)", state.problem,
                          state.problem_at, state.failures, state.stalls),
              Mark::warning);
  return report;
}

Report source_report(const LoadedSource& source) {
  if (source.camera) return camera_report(source);
  return source.depth_image ? image_report(source) : cloud_report(source);
}

void add_trust(Report& report, const Prepared::Report& prepared) {
  report.data["trust"] = {{"low", prepared.trust_low}, {"untrusted_share", prepared.untrusted}};
  if (prepared.untrusted < 0.01) return;
  report.line("trust",
              fmt::format("{:.0f} % of this cloud has low trust and is rendered as a metaball",
                          100 * prepared.untrusted));
}

std::string in_words(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return fmt::format("{} x {} pixels, focal length {:.4g} px", camera.width, camera.height,
                     0.5 * (p.fx + p.fy));
}

Json json_of(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return {{"width", camera.width},
          {"height", camera.height},
          {"pinhole_px", {{"fx", p.fx}, {"fy", p.fy}, {"cx", p.cx}, {"cy", p.cy}}}};
}

}  // namespace palpate::app
