// Reports on sources: clouds, depth images, cameras.
#include "apps/palpate/report/source_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "scene/description.hpp"

namespace palpate::app {

namespace {

// A phase at the end of a run.
std::string_view phase_words(StreamState::Phase phase) {
  if (phase == StreamState::Phase::starting) return "no frame arrived";
  if (phase == StreamState::Phase::ended) return "ended; its last surface was kept";
  return name_of(phase);
}

// Quantiles of a duration.
struct Quantiles {
  double p50 = 0;
  double p99 = 0;
  double most = 0;
};

Quantiles quantiles_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {quantile(values, 0.5), quantile(values, 0.99), quantile(values, 1)};
}

// The share of a simulated run's frames that a live run would have dropped, as preparing a frame
// takes longer than a frame; 0 for a live run. `p50_ms`: of the preparation.
double share_too_fast(const FeedReport& feed, double p50_ms) {
  if (!feed.simulated || !(p50_ms > 0) || !(feed.state.rate > 0)) return 0;
  return std::max(0.0, 1 - 1e3 / (p50_ms * feed.state.rate));
}

Report file_report(const LoadedSource& source) {
  const CloudArgument& argument = source.plan.argument;
  Report report(argument.name, fmt::format("{} ({})", argument.path, source.format));
  report.data = {{"name", argument.name}, {"file", argument.path}, {"format", source.format}};
  return report;
}

void add_stored(Report& report, const LoadedSource& store) {
  const PrepareOptions& prepare = store.plan.options.prepare;
  report.row("stored",
             "{points_stored} points on disk, of which what is around tools was read"
             "[{?}; --radius and --voxel make it as the same points in memory with them]",
             store.declared, !prepare.radius || !prepare.voxel);
}

Report cloud_report(const LoadedSource& cloud) {
  const Prepared::Report& r = cloud.prepared;
  Report report = file_report(cloud);
  report.data["points_declared"] = cloud.declared;
  if (cloud.splats) {
    add_splats(report, *cloud.splats, cloud.declared, cloud.dropped, r.points_in);
  }
  if (cloud.mesh) add_mesh(report, *cloud.mesh, r.points_in);
  if (cloud.paged) add_stored(report, cloud);
  report.row("points",
             "{points_read} read, {points_felt} felt[, {points_duplicate} duplicates]"
             "[, {points_speckle} dropped as speckle][, {points_invalid} invalid]",
             cloud.paged ? r.points_out + r.duplicates + r.speckle : r.points_in, r.points_out,
             r.duplicates, r.speckle, cloud.splats ? 0 : cloud.dropped);
  if (cloud.on_demand && !cloud.paged) {
    const double share = cloud.on_demand->share();
    report.data["prepared_share"] = share;
    report.row("so far", "[{?}{} % of the cloud when the run ended]", share < 1,
               std::floor(100 * share));
  }
  report.row({"units", Mark::warning}, "[{?}{}? {}; {}]", cloud.units.advice, cloud.units.units,
             cloud.units.reason, cloud.units.advice);
  report.row("spacing", "{spacing_m}, noise {noise_m}, voxel [{voxel_m}|none]", r.spacing, r.noise,
             r.voxel);
  report.row("R", "{radius_m/median}[{?} ({radius_m/smallest} to {radius_m/largest})]", r.radius,
             r.radius_largest > 1.001 * r.radius_smallest, r.radius_smallest, r.radius_largest);
  add_trust(report, r);
  report.row("prepared",
             "{seconds/prepare} after {seconds/read} of reading: filter {seconds/filter}, index "
             "{seconds/index}, spacing {seconds/spacing}, normals {seconds/normals}, weights "
             "{seconds/weights}",
             cloud.prepare_seconds, cloud.read_seconds, r.seconds_filter, r.seconds_index,
             r.seconds_spacing, r.seconds_normals, r.seconds_weights);
  return report;
}

void add_seen(Report& report, const Source::State& state) {
  report.row("points", "{points_felt} felt[, image centre {depth_m} away]", state.points,
             state.depth);
  report.row("noise",
             "[{?}{noise_m} per pixel there][{?}, correlation {noise_correlation} (1: independent "
             "pixels)]",
             state.depth > 0, state.noise, state.depth > 0 && state.correlation > 1.01,
             state.correlation);
  if (!state.disagreement) return;
  report.row("disagrees", "{disagreement_m} with the other sources where both see a surface",
             *state.disagreement);
}

Report image_report(const LoadedSource& source) {
  Report report = file_report(source);
  if (source.lens.width > 0) add_organised(report, source.lens, "processed as a depth frame");
  add_seen(report, source.state);
  report.row("prepared", "{seconds/prepare} after {seconds/read} of reading",
             source.prepare_seconds, source.read_seconds);
  return report;
}

void add_frames(Report& report, const FeedReport& feed) {
  const StreamState& state = feed.state;
  const StreamState::Drops& drops = state.drops;
  report.data.update({{"width", feed.width},
                      {"height", feed.height},
                      {"phase", name_of(state.phase)},
                      {"failures", state.failures},
                      {"stalls", state.stalls}});
  report.row("frames",
             "{frames_touchable} of {frames} touchable, {rate_Hz}[, {drops/overtaken} overtaken]"
             "[, {drops/repeated} repeated][, {drops/late} late][, {drops/empty} empty]"
             "[, {drops/garbage} garbage][, {drops/unposed} without a pose]"
             "[, {drops/resized} of a different size][, {drops/refused} refused]",
             state.touchable, state.frames, state.rate, drops.overtaken, drops.repeated, drops.late,
             drops.empty, drops.garbage, drops.unposed, drops.resized, drops.refused);
}

// `whole`: frames are clouds, none of which was clipped.
void add_latency(Report& report, const FeedReport& feed, bool whole) {
  const Quantiles latency = quantiles_of(feed.latency_s);
  const Quantiles times = quantiles_of(feed.prepare_ms);
  const bool late = whole && feed.simulated && times.p50 > 1e3 * kLateCloud;
  const double dropped = late ? 0 : share_too_fast(feed, times.p50);
  report.row("latency",
             "{latency_s/p50} (p50), {latency_s/p99} (p99), {latency_s/max} (max) from frame to "
             "touchable; preparation {prepare_ms/p50} (p50), {prepare_ms/max} (max)",
             latency.p50, latency.p99, latency.most, times.p50, times.most);
  report.data["would_drop_live"] = dropped;
  report.row({"too slow", Mark::warning},
             "[{?}preparing a frame takes {_ms}, but frames arrive every {_s}: live, {_share} "
             "would be dropped]",
             dropped, times.p50, 1 / feed.state.rate,
             std::min(0.99, std::ceil(100 * dropped) / 100));
  report.row("slow",
             "[{?}preparing a frame takes {_ms}: live, only what tools can reach is prepared]",
             late, times.p50);
}

void add_policy(Report& report, const SourcePlan& plan) {
  const Policy policy = policy_of(plan);
  const char* const name = name_in(kPolicies, policy);
  if (keeps_history(policy)) {
    report.row("policy", "{policy/name} of {policy/history}", name, plan.options.policy.history);
  } else {
    report.row("policy", "{policy/name}", name);
  }
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
  report.row("assumed", "[{}]", source.camera ? source.camera->info().assumed : "");
  add_frames(report, feed);
  const bool clips = source.plan.options.policy.clip_to_reach;  // from the first cloud on
  const bool clipped = source.state.clipped;
  add_latency(report, feed, source.plan.as_cloud && !clips && !clipped);
  add_policy(report, source.plan);
  add_seen(report, source.state);
  report.row("clipped",
             "[{?}to what tools can reach, since surfaces of whole clouds came {_s} late and more]",
             clipped && !clips, kLateCloud);
  report.row({"problem", Mark::warning},
             "[{problem}][{?} (at {_s}; {} failed reads, stalled {} times)]", state.problem,
             !state.problem.empty(), state.problem_at, state.failures, state.stalls);
  return report;
}

Report source_report(const LoadedSource& source) {
  if (source.camera) return camera_report(source);
  return source.depth_image ? image_report(source) : cloud_report(source);
}

void add_trust(Report& report, const Prepared::Report& prepared) {
  report.data["trust"] = {{"low", prepared.trust_low}};
  report.row("trust",
             "[{?}{trust/untrusted_share} of this cloud has low trust and is rendered as a "
             "metaball]",
             prepared.untrusted >= 0.01, prepared.untrusted);
}

void add_splats(Report& report, const SplatFacts& splats, std::size_t declared, std::size_t dropped,
                std::size_t points) {
  report.row("splats",
             "{splats/read} read[, {splats/invalid} invalid], {splats/visible} of opacity 0.02 and "
             "more[; left out: {splats/far} too far away][; left out: {splats/huge} too large]; "
             "shell {splats/points} points, {splats/spacing_m} apart[; "
             "{splats/unsure_share} without a normal of their own][; {splats/pieces} pieces of "
             "less than 60 cells dropped]",
             declared, dropped, splats.visible, splats.far, splats.huge, points, splats.spacing,
             splats.without_normal, splats.pieces);
}

void add_mesh(Report& report, const MeshFacts& mesh, std::size_t points) {
  const bool sampled = mesh.spacing > 0;
  report.row("mesh",
             "of {mesh/triangles} triangles: felt as {} points[{?} sampled from it, "
             "{mesh/spacing_m} apart|, its vertices][, {mesh/faces_duplicate} duplicate faces]"
             "[, {mesh/faces_dropped} without an area]",
             mesh.triangles, points, sampled, mesh.spacing, mesh.duplicates, mesh.dropped);
}

void add_organised(Report& report, const CameraModel& camera, const std::string& processed) {
  const Pinhole& p = camera.pinhole;
  report.row("organised", "{organised/width} x {organised/height} pixels, focal length {_px}, {}",
             camera.width, camera.height, 0.5 * (p.fx + p.fy), processed);
  report.data["organised"]["pinhole_px"] = {{"fx", p.fx}, {"fy", p.fy}, {"cx", p.cx}, {"cy", p.cy}};
}

}  // namespace palpate::app
