#include "apps/palpate/source_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/palpate/words.hpp"

namespace palpate::app {

namespace {

using Json = nlohmann::ordered_json;

std::string range(double smallest, double middle, double largest) {
  if (largest <= 1.001 * smallest) return length(middle);
  return fmt::format("{} ({} to {})", length(middle), length(smallest), length(largest));
}

void print_cloud(const TouchedSource& cloud, const Style& style, std::FILE* out) {
  const PrepareReport& r = cloud.prepared;
  fmt::print(out, "{} {} ({})\n", style.heading(cloud.argument.name), cloud.argument.path,
             cloud.format);
  fmt::print(out, "  points     {} read, {} felt", grouped(r.points_in), grouped(r.points_out));
  if (r.speckle > 0) fmt::print(out, ", {} dropped as speckle", grouped(r.speckle));
  if (cloud.dropped > 0) fmt::print(out, ", {} invalid", grouped(cloud.dropped));
  fmt::print(out, "\n");
  if (!cloud.units.advice.empty()) {
    fmt::print(out, "  {} {}? {}; {}\n", style.warning("units     "), cloud.units.units,
               cloud.units.reason, cloud.units.advice);
  }
  fmt::print(out, "  spacing    {}, noise {}, voxel {}\n", length(r.spacing), length(r.noise),
             r.voxel > 0 ? length(r.voxel) : "none");
  fmt::print(out, "  R          {}\n", range(r.radius_smallest, r.radius, r.radius_largest));
  fmt::print(out,
             "  prepared   {} after {} of reading: filter {}, index {}, spacing {}, normals {}, "
             "weights {}\n",
             duration(cloud.prepare_seconds), duration(cloud.read_seconds),
             duration(r.seconds_filter), duration(r.seconds_index), duration(r.seconds_spacing),
             duration(r.seconds_normals), duration(r.seconds_weights));
}

Json json_cloud(const TouchedSource& cloud) {
  const PrepareReport& r = cloud.prepared;
  return {{"name", cloud.argument.name},
          {"file", cloud.argument.path},
          {"format", cloud.format},
          {"points_declared", cloud.declared},
          {"points_invalid", cloud.dropped},
          {"points_read", r.points_in},
          {"points_felt", r.points_out},
          {"points_speckle", r.speckle},
          {"spacing_m", r.spacing},
          {"noise_m", r.noise},
          {"voxel_m", r.voxel},
          {"radius_m",
           {{"median", r.radius}, {"smallest", r.radius_smallest}, {"largest", r.radius_largest}}},
          {"seconds",
           {{"read", cloud.read_seconds},
            {"prepare", cloud.prepare_seconds},
            {"filter", r.seconds_filter},
            {"index", r.seconds_index},
            {"spacing", r.seconds_spacing},
            {"normals", r.seconds_normals},
            {"weights", r.seconds_weights}}}};
}

// A value that a share of all is no larger than.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size()) - 1;
  return values[static_cast<std::size_t>(std::lround(share * last))];
}

const char* phase_text(StreamPhase phase) {
  switch (phase) {
    case StreamPhase::starting:
      return "no frame came";
    case StreamPhase::running:
      return "running";
    case StreamPhase::stalled:
      return "stalled";
    case StreamPhase::failed:
      return "failed";
    case StreamPhase::ended:
      return "ended; its last surface stayed";
  }
  return "";
}

const char* phase_name(StreamPhase phase) {
  switch (phase) {
    case StreamPhase::starting:
      return "starting";
    case StreamPhase::running:
      return "running";
    case StreamPhase::stalled:
      return "stalled";
    case StreamPhase::failed:
      return "failed";
    case StreamPhase::ended:
      return "ended";
  }
  return "";
}

Policy policy_of(const TouchedSource& source) {
  const Policy unset = source.as_cloud ? Policy::crossfade : Policy::morph;
  return source.options.policy.policy.value_or(unset);
}

const char* policy_name(const TouchedSource& source) {
  switch (policy_of(source)) {
    case Policy::replace:
      return "replace";
    case Policy::average:
      return "average";
    case Policy::crossfade:
      return "crossfade";
    case Policy::fusion:
      return "fusion";
    case Policy::morph:
      return "morph";
  }
  return "";
}

bool keeps_history(const TouchedSource& source) {
  const Policy policy = policy_of(source);
  return policy == Policy::average || policy == Policy::crossfade;
}

// "overtaken 3, late 1"; empty: none.
std::string drops_text(const StreamDrops& drops) {
  std::string text;
  const auto add = [&](const char* cause, std::uint64_t count) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, cause);
  };
  add("overtaken", drops.overtaken);
  add("repeated", drops.repeated);
  add("late", drops.late);
  add("empty", drops.empty);
  add("garbage", drops.garbage);
  add("of another size", drops.resized);
  add("refused", drops.refused);
  return text;
}

void print_depth(const SourceState& state, std::FILE* out) {
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

void print_image(const TouchedSource& source, const Style& style, std::FILE* out) {
  fmt::print(out, "{} {} ({})\n", style.heading(source.argument.name), source.argument.path,
             source.format);
  print_depth(source.state, out);
  fmt::print(out, "  prepared   {} after {} of reading\n", duration(source.prepare_seconds),
             duration(source.read_seconds));
}

void print_live(const TouchedSource& source, const Style& style, std::FILE* out) {
  const FeedReport& feed = source.feed;
  const StreamState& state = feed.state;
  fmt::print(out, "{} {} ({} x {} pixels), {}\n", style.heading(source.argument.name),
             source.argument.path, feed.width, feed.height, phase_text(state.phase));
  fmt::print(out, "  frames     {} touchable of {}, {:.1f} a second; {} dropped\n",
             grouped(state.touchable), grouped(state.frames), state.rate,
             state.drops.total() == 0 ? "none" : drops_text(state.drops));
  fmt::print(
      out, "  latency    {} from frame to touchable, {} at worst; prepared in {} (p50), {} (max)\n",
      duration(state.latency_mean), duration(state.latency_worst),
      duration(1e-3 * quantile(feed.prepare_ms, 0.5)),
      duration(1e-3 * quantile(feed.prepare_ms, 1)));
  fmt::print(out, "  policy     {}", policy_name(source));
  if (keeps_history(source)) fmt::print(out, " of {}", source.options.policy.history);
  fmt::print(out, "\n");
  print_depth(source.state, out);
  if (state.problem.empty()) return;
  fmt::print(out, "  {} {} (at {:.3f} s; {} failed reads, {} without an answer)\n",
             style.warning("problem   "), state.problem, state.problem_at, state.failures,
             state.stalls);
}

Json json_depth(const SourceState& state) {
  Json json = {{"points_felt", state.points},
               {"depth_m", state.depth},
               {"noise_m", state.noise},
               {"noise_correlation", state.correlation}};
  if (state.disagreement) json["disagreement_m"] = *state.disagreement;
  return json;
}

Json json_image(const TouchedSource& source) {
  Json json = {{"name", source.argument.name},
               {"file", source.argument.path},
               {"format", source.format},
               {"seconds", {{"read", source.read_seconds}, {"prepare", source.prepare_seconds}}}};
  json.update(json_depth(source.state));
  return json;
}

Json json_live(const TouchedSource& source) {
  const FeedReport& feed = source.feed;
  const StreamState& state = feed.state;
  const StreamDrops& drops = state.drops;
  Json policy = {{"name", policy_name(source)}};
  if (keeps_history(source)) policy["history"] = source.options.policy.history;
  Json json = {{"name", source.argument.name},
               {"camera", source.argument.path},
               {"width", feed.width},
               {"height", feed.height},
               {"phase", phase_name(state.phase)},
               {"frames", state.frames},
               {"frames_touchable", state.touchable},
               {"rate_Hz", state.rate},
               {"drops",
                {{"overtaken", drops.overtaken},
                 {"repeated", drops.repeated},
                 {"late", drops.late},
                 {"empty", drops.empty},
                 {"garbage", drops.garbage},
                 {"resized", drops.resized},
                 {"refused", drops.refused}}},
               {"failures", state.failures},
               {"stalls", state.stalls},
               {"problem", state.problem},
               {"latency_s", {{"mean", state.latency_mean}, {"worst", state.latency_worst}}},
               {"prepare_ms",
                {{"p50", quantile(feed.prepare_ms, 0.5)}, {"max", quantile(feed.prepare_ms, 1)}}},
               {"policy", policy}};
  json.update(json_depth(source.state));
  return json;
}

}  // namespace

void print_source(const TouchedSource& source, std::FILE* out) {
  const Style style(out);
  if (source.camera) {
    print_live(source, style, out);
  } else if (source.depth_image) {
    print_image(source, style, out);
  } else {
    print_cloud(source, style, out);
  }
}

Json json_source(const TouchedSource& source) {
  if (source.camera) return json_live(source);
  return source.depth_image ? json_image(source) : json_cloud(source);
}

}  // namespace palpate::app
