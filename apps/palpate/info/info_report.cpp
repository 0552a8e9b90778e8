#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/info/info_command.hpp"
#include "apps/palpate/report/report.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate::app {

namespace {

Json list(const Eigen::Vector3d& v) {
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

std::string organised_as(const InfoReport& report) {
  const PointCloud& cloud = report.loaded.file.cloud;
  if (!report.organised.frame) {
    return fmt::format("{} x {}, processed as unorganised points: {}", cloud.width, cloud.height,
                       report.organised.why_none);
  }
  return in_words(report.organised.frame->camera) +
         (report.image.depth > 0 ? ", processed as a depth frame"
                                 : ", processed as unorganised points: half are nearer than 0.1 m "
                                   "or farther than 20 m; check --scale");
}

void add_points(Report& report, const InfoReport& info) {
  const CloudFile& file = info.loaded.file;
  report.line("points",
              grouped(file.cloud.size()) +
                  (file.dropped > 0 ? fmt::format(", {} of {} declared dropped as invalid",
                                                  grouped(file.dropped), grouped(file.declared))
                                    : ""));
  if (file.cloud.width > 0) report.line("organised", organised_as(info));
  report.line("holds", columns_of(file.cloud));
  if (file.cloud.viewpoint) {
    const Eigen::Vector3d& v = *file.cloud.viewpoint;
    report.line("viewpoint", fmt::format("{:.4g}, {:.4g}, {:.4g}", v.x(), v.y(), v.z()));
  }
  Json organised;
  if (info.organised.frame) {
    organised = json_of(info.organised.frame->camera);
    organised.update({{"residual_px", info.organised.residual},
                      {"felt_as_frame", info.image.depth > 0},
                      {"points_felt", info.image.points},
                      {"radius_m", info.image_radius}});
  }
  report.data.update({{"points", file.cloud.size()},
                      {"points_declared", file.declared},
                      {"points_invalid", file.dropped},
                      {"width", file.cloud.width},
                      {"height", file.cloud.height},
                      {"organised", organised},
                      {"normals", !file.cloud.normals.empty()},
                      {"colors", !file.cloud.colors.empty()},
                      {"intensities", !file.cloud.intensities.empty()}});
}

void add_bounds(Report& report, const InfoReport& info) {
  const Box& box = info.bounds;
  const Eigen::Vector3d size = box.size();
  for (int axis = 0; axis < 3; ++axis) {
    report.line(std::string(1, "xyz"[axis]),
                fmt::format("{:.6g} to {:.6g}, {} long", box.lower[axis], box.upper[axis],
                            length(size[axis])));
  }
  const Eigen::Vector3d core = info.core.size();
  if (core != size) {
    report.line("core", fmt::format("{} x {} x {} without outliers", length(core.x()),
                                    length(core.y()), length(core.z())));
  }
  const UnitsGuess& units = info.units;
  report.line("units", fmt::format("{}: {}", units.units, units.reason));
  if (!units.advice.empty()) report.line("", units.advice);
  report.data["bounds_m"] = {{"lower", list(box.lower)}, {"upper", list(box.upper)}};
  report.data["units"] = {
      {"guess", units.units}, {"reason", units.reason}, {"advice", units.advice}};
}

void add_surface(Report& report, const InfoReport& info) {
  if (on_a_line(info.loaded.file.cloud.positions)) {
    report.line("surface", kNoSurface, Mark::warning);
  }
  const SpacingFacts& s = info.spacing;
  report.line("spacing",
              fmt::format("{} to the three nearest, {} from area ({} to {} in the middle 80 %)",
                          length(s.nearest_three), length(s.from_area), length(s.tenth),
                          length(s.nine_tenths)));
  report.line("noise", fmt::format("{} from the local plane", length(info.prepared.noise)));
  report.line("holes",
              fmt::format("{:.1f} % of the points are at a border or a hole", 100 * info.rim));
  report.data.update({{"spacing_m",
                       {{"nearest_three", s.nearest_three},
                        {"from_area", s.from_area},
                        {"tenth", s.tenth},
                        {"nine_tenths", s.nine_tenths}}},
                      {"noise_m", info.prepared.noise},
                      {"rim_share", info.rim}});
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

Json json_of(const LiveFacts& facts) {
  Json json = {{"name", facts.argument.name}, {"camera", facts.argument.path},
               {"posed", facts.posed},        {"frames_unposed", facts.unposed},
               {"rate_Hz", facts.rate},       {"frames", facts.frames},
               {"failures", facts.failures}};
  if (facts.clouds) {
    json.update({{"points", facts.points}, {"spacing_m", facts.spacing}});
    return json;
  }
  const Pinhole& p = facts.pinhole;
  json.update({{"width", facts.width},
               {"height", facts.height},
               {"intrinsics", {p.fx, p.fy, p.cx, p.cy}},
               {"distorted", facts.distorted},
               {"frames_repeated", facts.repeated},
               {"valid_share", facts.valid},
               {"depth_m",
                {{"hundredth", facts.nearest},
                 {"median", facts.depth},
                 {"last_hundredth", facts.farthest}}},
               {"noise",
                {{"coefficients", facts.noise.coefficients},
                 {"correlation", facts.noise.correlation},
                 {"at_median_m", facts.noise.sigma(facts.depth)}}}});
  return json;
}

void add_lens(Report& report, const LiveFacts& facts) {
  const Pinhole& p = facts.pinhole;
  report.line("intrinsics", fmt::format("{:.6g}, {:.6g}, {:.6g}, {:.6g}{}", p.fx, p.fy, p.cx, p.cy,
                                        facts.distorted ? ", with distortion" : ""));
}

void add_depths(Report& report, const LiveFacts& facts) {
  const auto& c = facts.noise.coefficients;
  report.line("depth", fmt::format("{:.0f} % of the pixels are valid, {} to {}, median {}",
                                   100 * facts.valid, length(facts.nearest), length(facts.farthest),
                                   length(facts.depth)));
  report.line("noise",
              fmt::format("{} per pixel at the median; --noise {:.4g},{:.4g},{:.4g},{:.3g}",
                          length(facts.noise.sigma(facts.depth)), c[0], c[1], c[2],
                          facts.noise.correlation));
}

}  // namespace

Report report_of(const InfoReport& info) {
  const CloudArgument& argument = info.loaded.argument;
  const std::string& format = info.loaded.file.format;
  const Prepared::Report& r = info.prepared;
  Report report(argument.name, fmt::format("{} ({}), read in {}", argument.path, format,
                                           duration(info.loaded.seconds)));
  report.data = {{"name", argument.name}, {"file", argument.path}, {"format", format}};
  add_points(report, info);
  add_bounds(report, info);
  add_surface(report, info);
  report.data["advice"] = {{"voxel_m", r.voxel},
                           {"radius_m", r.radius},
                           {"radius_smallest_m", r.radius_smallest},
                           {"radius_largest_m", r.radius_largest},
                           {"points_felt", r.points_out}};
  return report;
}

Report advice_of(const InfoReport& info) {
  const Prepared::Report& r = info.prepared;
  Report report("touch would use", "");
  if (info.image.depth > 0) {
    report.line("the depth filter",
                fmt::format("({} points, R {}); with --unorganised", grouped(info.image.points),
                            length(info.image_radius)));
  }
  report.line("--voxel", fmt::format("{:.3g} (keeps {} points{}{})", r.voxel, grouped(r.points_out),
                                     and_some(r.duplicates, "duplicates"),
                                     and_some(r.speckle, "dropped as speckle")));
  const std::string varies = r.radius_largest > 1.01 * r.radius_smallest
                                 ? fmt::format("; varies with the density, {} to {}",
                                               length(r.radius_smallest), length(r.radius_largest))
                                 : "";
  report.line("--radius", fmt::format("{:.3g} ({:.1f} times the spacing{})", r.radius,
                                      r.spacing > 0 ? r.radius / r.spacing : 0, varies));
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
    facts.spacing = measure_spacing(CellGrid(frame.cloud->positions)).from_area;
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
  if (!facts.clouds) add_lens(report, facts);
  if (!facts.assumed.empty()) report.line("assumed", facts.assumed);
  report.line("frames",
              fmt::format("{:.1f} Hz; of the first {}: {} repeated, {} failed", facts.rate,
                          facts.frames + facts.failures, facts.repeated, facts.failures));
  report.line(
      "poses",
      fmt::format(
          "{}{}", facts.posed ? "each frame has one" : "none; set one with --pose",
          facts.unposed > 0 ? fmt::format("; {} frames without one skipped", facts.unposed) : ""));
  if (facts.clouds) {
    report.line("points", fmt::format("{} in the first, {} apart", grouped(facts.points),
                                      length(facts.spacing)));
  } else {
    add_depths(report, facts);
  }
  report.data = json_of(facts);
  return report;
}

}  // namespace palpate::app
