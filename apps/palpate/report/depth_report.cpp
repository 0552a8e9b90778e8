#include "apps/palpate/report/depth_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/touch_surface.hpp"

namespace palpate::app {

namespace {

// What is said of a phase at the end of a run.
std::string_view in_words(StreamPhase phase) {
  if (phase == StreamPhase::starting) return "no frame came";
  if (phase == StreamPhase::ended) return "ended; its last surface stayed";
  return name_of(phase);
}

// A cause for which frames are dropped: its name in data, and what is said of it.
struct DropText {
  std::uint64_t StreamDrops::*count;
  const char* name;
  const char* words;
};

constexpr std::array<DropText, 8> kDrops = {{{&StreamDrops::overtaken, "overtaken", "overtaken"},
                                             {&StreamDrops::repeated, "repeated", "repeated"},
                                             {&StreamDrops::late, "late", "late"},
                                             {&StreamDrops::empty, "empty", "empty"},
                                             {&StreamDrops::garbage, "garbage", "garbage"},
                                             {&StreamDrops::unposed, "unposed", "without a pose"},
                                             {&StreamDrops::resized, "resized", "of another size"},
                                             {&StreamDrops::refused, "refused", "refused"}}};

// "overtaken 3, late 1".
std::string in_words(const StreamDrops& drops) {
  std::string words;
  for (const DropText& each : kDrops) {
    const std::uint64_t count = drops.*each.count;
    if (count > 0) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, each.words);
  }
  return words.empty() ? "none" : words;
}

Json json_drops(const StreamDrops& drops) {
  Json json;
  for (const DropText& each : kDrops) json[each.name] = drops.*each.count;
  return json;
}

// Of the preparation of a frame, ms.
struct PrepareQuantiles {
  double p50 = 0;
  double longest = 0;
};

PrepareQuantiles prepare_times(std::vector<double> ms) {
  std::ranges::sort(ms);
  return {quantile(ms, 0.5), quantile(ms, 1)};
}

// The share of frames of a run in simulated time that live would have been overtaken while others
// were prepared; 0 for a run that was live.
double share_too_fast(const FeedReport& feed, const PrepareQuantiles& times) {
  if (!feed.simulated || !(times.p50 > 0) || !(feed.state.rate > 0)) return 0;
  return std::max(0.0, 1 - 1e3 / (times.p50 * feed.state.rate));
}

void print_too_fast(const FeedReport& feed, const PrepareQuantiles& times, const Style& style,
                    std::FILE* out) {
  const double dropped = share_too_fast(feed, times);
  if (dropped == 0) return;
  fmt::print(out,
             "  {} a frame takes {} to prepare and comes every {}: live, {:.0f} % of them would be "
             "dropped\n",
             style.warning("too slow  "), duration(1e-3 * times.p50), duration(1 / feed.state.rate),
             std::min(99.0, std::ceil(100 * dropped)));
}

void print_seen(const SourceState& state, std::FILE* out) {
  fmt::print(out, "  points     {} felt", grouped(state.points));
  if (state.depth > 0) {
    fmt::print(out, ", the middle of the image {} away\n", length(state.depth));
    fmt::print(out, "  noise      {} a pixel there{}", length(state.noise),
               state.correlation > 1.01
                   ? fmt::format(", {:.2f} times that in means of neighbours", state.correlation)
                   : "");
  }
  fmt::print(out, "\n");
  if (state.disagreement) {
    fmt::print(out, "  disagrees  {} with the other sources where both see a surface\n",
               length(*state.disagreement));
  }
}

Json json_seen(const SourceState& state) {
  Json json = {{"points_felt", state.points},
               {"depth_m", state.depth},
               {"noise_m", state.noise},
               {"noise_correlation", state.correlation}};
  if (state.disagreement) json["disagreement_m"] = *state.disagreement;
  return json;
}

}  // namespace

void print_camera(const TouchedSource& source, const Style& style, std::FILE* out) {
  const FeedReport& feed = source.feed;
  const StreamState& state = feed.state;
  const PrepareQuantiles times = prepare_times(feed.prepare_ms);
  fmt::print(out, "{} {} ({} x {} pixels), {}\n", style.heading(source.argument.name),
             source.argument.path, feed.width, feed.height, in_words(state.phase));
  fmt::print(out, "  frames     {} touchable of {}, {:.1f} a second; {} dropped\n",
             grouped(state.touchable), grouped(state.frames), state.rate, in_words(state.drops));
  fmt::print(
      out, "  latency    {} from frame to touchable, {} at worst; prepared in {} (p50), {} (max)\n",
      duration(state.latency_mean), duration(state.latency_worst), duration(1e-3 * times.p50),
      duration(1e-3 * times.longest));
  print_too_fast(feed, times, style, out);
  const Policy policy = policy_of(source.options, source.as_cloud);
  fmt::print(out, "  policy     {}", name_in(kPolicies, policy));
  if (keeps_history(policy)) fmt::print(out, " of {}", source.options.policy.history);
  fmt::print(out, "\n");
  print_seen(source.state, out);
  if (state.problem.empty()) return;
  fmt::print(out, "  {} {} (at {:.3f} s; {} failed reads, stalled {} times)\n",
             style.warning("problem   "), state.problem, state.problem_at, state.failures,
             state.stalls);
}

Json json_camera(const TouchedSource& source) {
  const FeedReport& feed = source.feed;
  const StreamState& state = feed.state;
  const PrepareQuantiles times = prepare_times(feed.prepare_ms);
  const Policy chosen = policy_of(source.options, source.as_cloud);
  Json policy = {{"name", name_in(kPolicies, chosen)}};
  if (keeps_history(chosen)) policy["history"] = source.options.policy.history;
  Json json = {{"name", source.argument.name},
               {"camera", source.argument.path},
               {"width", feed.width},
               {"height", feed.height},
               {"phase", name_of(state.phase)},
               {"frames", state.frames},
               {"frames_touchable", state.touchable},
               {"rate_Hz", state.rate},
               {"drops", json_drops(state.drops)},
               {"failures", state.failures},
               {"stalls", state.stalls},
               {"problem", state.problem},
               {"latency_s", {{"mean", state.latency_mean}, {"worst", state.latency_worst}}},
               {"prepare_ms", {{"p50", times.p50}, {"max", times.longest}}},
               {"would_drop_live", share_too_fast(feed, times)},
               {"policy", policy}};
  json.update(json_seen(source.state));
  return json;
}

std::string in_words(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return fmt::format("{} x {} pixels of a camera of {:.4g} px", camera.width, camera.height,
                     0.5 * (p.fx + p.fy));
}

Json json_of(const CameraModel& camera) {
  const Pinhole& p = camera.pinhole;
  return {{"width", camera.width},
          {"height", camera.height},
          {"pinhole_px", {{"fx", p.fx}, {"fy", p.fy}, {"cx", p.cx}, {"cy", p.cy}}}};
}

void print_depth_image(const TouchedSource& source, const Style& style, std::FILE* out) {
  fmt::print(out, "{} {} ({})\n", style.heading(source.argument.name), source.argument.path,
             source.format);
  if (source.lens.width > 0) {
    fmt::print(out, "  organised  {}, felt as a depth frame\n", in_words(source.lens));
  }
  print_seen(source.state, out);
  fmt::print(out, "  prepared   {} after {} of reading\n", duration(source.prepare_seconds),
             duration(source.read_seconds));
}

Json json_depth_image(const TouchedSource& source) {
  Json json = {{"name", source.argument.name},
               {"file", source.argument.path},
               {"format", source.format},
               {"seconds", {{"read", source.read_seconds}, {"prepare", source.prepare_seconds}}}};
  if (source.lens.width > 0) json["organised"] = json_of(source.lens);
  json.update(json_seen(source.state));
  return json;
}

}  // namespace palpate::app
