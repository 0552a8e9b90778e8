// Studies clouds and cameras for the command info and reports on them.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/info/info_command.hpp"
#include "apps/palpate/report/source_report.hpp"
#include "apps/palpate/report/tool_report.hpp"
#include "palpate/depth/depth_filter.hpp"
#include "palpate/servo/guard.hpp"
#include "palpate/servo/z_width.hpp"
#include "stream/faced_place.hpp"
#include "stream/one_view.hpp"

namespace palpate::app {

namespace {

std::vector<double> list(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::string columns_of(const PointCloud& cloud) {
  std::string text = "positions";
  if (!cloud.normals.empty()) text += ", normals";
  if (!cloud.colors.empty()) text += ", colours";
  if (!cloud.intensities.empty()) {
    const auto [low, high] =
        std::minmax_element(cloud.intensities.begin(), cloud.intensities.end());
    text += fmt::format(", intensities ({:.4g} to {:.4g})", *low, *high);
  }
  return text;
}

void add_grid(Report& report, const InfoReport& info) {
  const PointCloud& cloud = info.loaded.file.cloud;
  report.data.update({{"width", cloud.width}, {"height", cloud.height}, {"organised", Json()}});
  if (!info.organised.frame) {
    report.row("organised", "[{?}{width} x {height}, processed as unorganised points: {}]",
               cloud.width, cloud.width, cloud.height, info.organised.why_none);
    return;
  }
  const bool felt = info.image.depth > 0;
  add_organised(report, info.organised.frame->camera,
                felt ? "processed as a depth frame"
                     : "processed as unorganised points: half are nearer than 0.1 m or farther "
                       "than 20 m; check --scale");
  report.data["organised"].update({{"residual_px", info.organised.residual},
                                   {"felt_as_frame", felt},
                                   {"points_felt", info.image.points},
                                   {"radius_m", info.image_radius}});
}

/// From where alone the cloud holds a hand, or where a sensor may have stood.
void add_viewpoint(Report& report, const PointCloud& cloud) {
  if (cloud.viewpoint) {
    const bool proved = OneView{}.eye_of(cloud, {}, Eigen::Isometry3d::Identity()).has_value();
    report.row("viewpoint", "{}[: {?}nothing holds a hand from behind]", list(*cloud.viewpoint),
               proved);
  } else if (const auto faced = faced_place(cloud)) {
    report.note("viewpoint",
                fmt::format("none; the normals face one side: if a sensor there saw all of it, "
                            "--viewpoint {:.12g},{:.12g},{:.12g} lets nothing hold a hand from "
                            "behind",
                            faced->x(), faced->y(), faced->z()));
  }
}

void add_points(Report& report, const InfoReport& info) {
  const CloudFile& file = info.loaded.file;
  const PointCloud& cloud = file.cloud;
  const std::size_t dropped = file.splats ? 0 : file.dropped;
  if (file.splats) add_splats(report, *file.splats, file.declared, file.dropped, cloud.size());
  report.row("points",
             "{points}[, {points_invalid} of {points_declared} declared dropped as invalid]",
             cloud.size(), dropped, file.declared);
  if (file.mesh) add_mesh(report, *file.mesh, cloud.size());
  add_grid(report, info);
  report.note("holds", columns_of(cloud));
  report.data.update({{"normals", !cloud.normals.empty()},
                      {"colors", !cloud.colors.empty()},
                      {"intensities", !cloud.intensities.empty()}});
  add_viewpoint(report, cloud);
}

void add_bounds(Report& report, const InfoReport& info) {
  const Box& box = info.bounds;
  const Eigen::Vector3d size = box.size();
  report.data["bounds_m"] = {{"lower", list(box.lower)}, {"upper", list(box.upper)}};
  for (int axis = 0; axis < 3; ++axis) {
    report.row(std::string(1, "xyz"[axis]), "{} to {}, {_m} long", box.lower[axis], box.upper[axis],
               size[axis]);
  }
  const Eigen::Vector3d core = info.core.size();
  report.row("core", "[{?}{_m} x {_m} x {_m} without outliers]", core != size, core.x(), core.y(),
             core.z());
  report.row("units", "{units/guess}: {units/reason}", info.units.units, info.units.reason);
  report.row("", "[{units/advice}]", info.units.advice);
}

void add_surface(Report& report, const InfoReport& info) {
  if (on_a_line(info.loaded.file.cloud.positions)) {
    report.note({"surface", Mark::warning}, kNoSurface);
  }
  report.row("spacing",
             "{spacing_m/from_area} from area or lines[{?} of the points that are kept], "
             "{spacing_m/nearest_three} to the three nearest of all",
             info.prepared.spacing, info.prepared.voxel > 0, info.nearest_three);
  report.row("noise", "{noise_m} from a smooth surface", info.prepared.noise);
  report.row("holes", "{rim_share} of the points are at a border or a hole", info.rim);
  add_trust(report, info.prepared);
}

constexpr std::size_t kFrames = 30;
constexpr int kTries = 200;    // answers of any kind
constexpr double kWait = 0.1;  // s

void look_at_depths(const DepthFrame& frame, LiveFacts& facts) {
  std::vector<float> depths;
  for (const float z : frame.depth) {
    if (z > 0) depths.push_back(z);
  }
  facts.valid = static_cast<double>(depths.size()) / static_cast<double>(frame.depth.size());
  if (depths.empty()) return;
  std::sort(depths.begin(), depths.end());
  facts.nearest = quantile(depths, 0.01);
  facts.depth = quantile(depths, 0.5);
  facts.farthest = quantile(depths, 0.99);
}

void filter_one(const DepthFrame& frame, DepthFilter& filter, LiveFacts& facts) {
  const Eigen::Isometry3d pose = frame.T_world_sensor.value_or(Eigen::Isometry3d::Identity());
  const FilteredDepth& depth = filter.filter(frame, pose, {});
  facts.noise = depth.noise;
  facts.repeated += depth.duplicate ? 1 : 0;
}

void add_lens(Report& report, const LiveFacts& facts) {
  const Pinhole& p = facts.pinhole;
  report.data.update(
      {{"width", facts.width}, {"height", facts.height}, {"frames_repeated", facts.repeated}});
  report.row("intrinsics", "{intrinsics}[, with distortion{distorted}]",
             std::vector{p.fx, p.fy, p.cx, p.cy}, facts.distorted);
}

void add_depths(Report& report, const LiveFacts& facts) {
  const auto& c = facts.noise.coefficients;
  const double correlation = facts.noise.correlation;
  report.row("depth",
             "{valid_share} of the pixels are valid, {depth_m/hundredth} to "
             "{depth_m/last_hundredth}, median {depth_m/median}",
             facts.valid, facts.nearest, facts.farthest, facts.depth);
  report.data["noise"] = {{"coefficients", c}, {"correlation", correlation}};
  report.row("noise", "{noise/at_median_m} per pixel at the median; --noise {}",
             facts.noise.sigma(facts.depth),
             fmt::format("{:.4g},{:.4g},{:.4g},{:.3g}", c[0], c[1], c[2], correlation));
}

}  // namespace

Report report_of(const InfoReport& info) {
  const CloudArgument& argument = info.loaded.argument;
  const std::string& format = info.loaded.file.format;
  Report report(argument.name, fmt::format("{} ({}), read in {}", argument.path, format,
                                           duration(info.loaded.seconds)));
  report.data = {{"name", argument.name}, {"file", argument.path}, {"format", format}};
  add_points(report, info);
  add_bounds(report, info);
  return report;
}

void add_study(Report& report, const InfoReport& info) {
  const Prepared::Report& r = info.prepared;
  add_surface(report, info);
  report.data["advice"] = {{"voxel_m", r.voxel},
                           {"radius_m", r.radius},
                           {"radius_smallest_m", r.radius_smallest},
                           {"radius_largest_m", r.radius_largest},
                           {"points_felt", r.points_out}};
}

void report_tool(Report& report, const ToolPlan& plan, double radius, std::FILE* out) {
  constexpr double kStiffness = 500;  // N/m of a surface, as touch has it by default
  constexpr double kClearance = 0.6;  // of R; with 0.5 a box lay on the rim in 5 of 8 runs
  constexpr double kPeriod = 1e-3;    // s; a device of 1 kHz whose force comes a step late
  const SampledTool tool = NamedTool(plan).sampled(radius);
  Report part("tool", radius > 0 ? "on this cloud" : "");
  add_tool(part, tool, kStiffness);
  // Turns are springs as shifts are (docs/method.md 8.1).
  const double held = GuardOptions().stiffness_share * passive_stiffness(1, kPeriod, kPeriod);
  part.row("",
           "a device of 1 kHz renders these turns with {tool/angular_damping_Nms_per_rad} "
           "N m s/rad of damping and more",
           tool.turns_with(kStiffness) / held);
  part.row(
      "",
      "[it enters a hole of this cloud that leaves {tool/clearance_m} on each side, and lies on "
      "the rim of a narrower one; a smaller R lets it in, from denser points or by --radius]",
      kClearance * radius);
  part.print(out);
  report.data.update(part.data);
}

Report advice_of(const InfoReport& info) {
  const Prepared::Report& r = info.prepared;
  Report report("touch would use", "");
  report.row("the depth filter", "[{?}({} points, R {_m}); with --unorganised]",
             info.image.depth > 0, info.image.points, info.image_radius);
  report.row("--voxel", "{} (keeps {} points[, {} duplicates][, {} dropped as speckle])",
             fmt::format("{:.3g}", r.voxel), r.points_out, r.duplicates, r.speckle);
  report.row("--radius", "{} ({} times the spacing[{?}; varies with the density, {_m} to {_m}])",
             fmt::format("{:.3g}", r.radius),
             fmt::format("{:.1f}", r.spacing > 0 ? r.radius / r.spacing : 0),
             r.radius_largest > 1.01 * r.radius_smallest, r.radius_smallest, r.radius_largest);
  return report;
}

LiveFacts study_live(const CloudArgument& argument) {
  const Waiting waiting("studying " + argument.name);
  SourcePlan source;
  source.argument = argument;
  const std::unique_ptr<DepthCamera> camera = open_stream_at_any_pace(source);
  LiveFacts facts;
  facts.argument = argument;
  facts.assumed = camera->info().assumed;
  DepthFrame frame = first_frame(*camera, &facts.failures);
  const double start = frame.stamp;
  double last = start;
  facts.width = frame.camera.width;
  facts.height = frame.camera.height;
  facts.pinhole = frame.camera.pinhole;
  facts.distorted = !frame.camera.distortion.none();
  facts.posed = frame.T_world_sensor.has_value();
  facts.clouds = frame.cloud != nullptr;
  if (facts.clouds) {
    facts.points = frame.cloud->size();
    facts.spacing = spacing_from_area(CellGrid(frame.cloud->positions));
  } else {
    look_at_depths(frame, facts);
  }
  DepthFilter filter;
  DepthCamera::Status status = DepthCamera::Status::frame;
  for (int i = 0; i < kTries && facts.frames < kFrames && status != DepthCamera::Status::ended;
       ++i) {
    if (status == DepthCamera::Status::frame) {
      if (!frame.cloud) filter_one(frame, filter, facts);
      ++facts.frames;
      last = frame.stamp;
    }
    status = camera->read(frame, kWait);
    facts.failures += is_failure(status) ? 1 : 0;
    facts.unposed += status == DepthCamera::Status::unposed ? 1 : 0;
  }
  if (last > start) facts.rate = static_cast<double>(facts.frames - 1) / (last - start);
  return facts;
}

Report report_of(const LiveFacts& facts) {
  Report report(facts.argument.name, facts.clouds
                                         ? facts.argument.path + " (clouds)"
                                         : fmt::format("{} ({} x {} pixels)", facts.argument.path,
                                                       facts.width, facts.height));
  report.data = {
      {"name", facts.argument.name}, {"camera", facts.argument.path}, {"frames", facts.frames}};
  if (!facts.clouds) add_lens(report, facts);
  report.row("assumed", "[{}]", facts.assumed);
  report.row("frames", "{rate_Hz}; of the first {}: {} repeated, {failures} failed", facts.rate,
             facts.frames + facts.failures, facts.repeated, facts.failures);
  report.row("poses",
             "[each frame has one{posed}|none; set one with --pose]"
             "[; {frames_unposed} frames without one skipped]",
             facts.posed, facts.unposed);
  if (facts.clouds) {
    report.row("points", "{points} in the first, {spacing_m} apart", facts.points, facts.spacing);
  } else {
    add_depths(report, facts);
  }
  return report;
}

}  // namespace palpate::app
