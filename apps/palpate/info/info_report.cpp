#include "apps/palpate/info/info_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/info/density_map.hpp"
#include "apps/palpate/report/depth_report.hpp"
#include "apps/palpate/report/source_report.hpp"

namespace palpate::app {

namespace {

constexpr int kMapColumns = 72;

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
    return fmt::format("{} x {}, felt as loose points: {}", cloud.width, cloud.height,
                       report.organised.why_none);
  }
  return in_words(report.organised.frame->camera) +
         (report.image.depth > 0 ? ", felt as a depth frame"
                                 : ", felt as loose points: half are nearer than 0.1 m or farther "
                                   "than 20 m; is --scale right?");
}

void print_points(const InfoReport& report, std::FILE* out) {
  const CloudFile& file = report.loaded.file;
  fmt::print(out, "  points     {}", grouped(file.cloud.size()));
  if (file.dropped > 0) {
    fmt::print(out, ", {} of {} announced dropped as invalid", grouped(file.dropped),
               grouped(file.declared));
  }
  fmt::print(out, "\n");
  if (file.cloud.width > 0) fmt::print(out, "  organised  {}\n", organised_as(report));
  fmt::print(out, "  holds      {}\n", columns_of(file.cloud));
  if (file.cloud.viewpoint) {
    const Eigen::Vector3d& v = *file.cloud.viewpoint;
    fmt::print(out, "  viewpoint  {:.4g}, {:.4g}, {:.4g}\n", v.x(), v.y(), v.z());
  }
}

void print_bounds(const InfoReport& report, std::FILE* out) {
  const Eigen::Vector3d size = report.bounds.size();
  for (int axis = 0; axis < 3; ++axis) {
    fmt::print(out, "  {}          {:.6g} to {:.6g}, {} long\n", "xyz"[axis],
               report.bounds.lower[axis], report.bounds.upper[axis], length(size[axis]));
  }
  const Eigen::Vector3d core = report.core.size();
  if (core != size) {
    fmt::print(out, "  core       {} x {} x {} but for some stray points\n", length(core.x()),
               length(core.y()), length(core.z()));
  }
  fmt::print(out, "  units      {}: {}\n", report.units.units, report.units.reason);
  if (!report.units.advice.empty()) fmt::print(out, "             {}\n", report.units.advice);
}

void print_surface(const InfoReport& report, std::FILE* out) {
  const SpacingFacts& s = report.spacing;
  fmt::print(out,
             "  spacing    {} to the three nearest, {} from area ({} to {} in the middle 80 %)\n",
             length(s.nearest_three), length(s.from_area), length(s.tenth), length(s.nine_tenths));
  fmt::print(out, "  noise      {} from the local plane\n", length(report.prepared.noise));
  fmt::print(out, "  holes      {:.1f} % of the points lie at a border or a hole\n",
             100 * report.rim);
  print_trust(report.prepared, out);
}

// What touch will do unless told otherwise, in the words of its options.
void print_advice(const InfoReport& report, const Style& style, std::FILE* out) {
  const PrepareReport& r = report.prepared;
  fmt::print(out, "{}\n", style.heading("touch would use"));
  if (report.image.depth > 0) {
    fmt::print(out, "  the depth filter ({} points, R {}); with --unorganised\n",
               grouped(report.image.points), length(report.image_radius));
  }
  fmt::print(out, "  --voxel    {:.3g} ({} points are left{}{})\n", r.voxel, grouped(r.points_out),
             r.duplicates > 0
                 ? fmt::format(", {} were at the place of another", grouped(r.duplicates))
                 : "",
             r.speckle > 0 ? fmt::format(", {} dropped as speckle", grouped(r.speckle)) : "");
  fmt::print(out, "  --radius   {:.3g} ({:.1f} times the spacing", r.radius,
             r.spacing > 0 ? r.radius / r.spacing : 0);
  if (r.radius_largest > 1.01 * r.radius_smallest) {
    fmt::print(out, "; it follows the density, {} to {}", length(r.radius_smallest),
               length(r.radius_largest));
  }
  fmt::print(out, ")\n");
}

void print_map(const InfoReport& report, const Style& style, std::FILE* out) {
  const DensityMap map = map_density(report.loaded.file.cloud, kMapColumns);
  const std::size_t largest = *std::max_element(map.counts.begin(), map.counts.end());
  fmt::print(out, "{} {} to the right, {} up; a letter is {} wide, the densest holds {} points\n{}",
             style.heading("density"), "xyz"[map.horizontal], "xyz"[map.vertical], length(map.cell),
             grouped(largest), draw(map, style.colored()));
}

}  // namespace

void print_report(const InfoReport& report, std::FILE* out) {
  const Style style(out);
  const CloudArgument& argument = report.loaded.argument;
  fmt::print(out, "{} {} ({}), read in {}\n", style.heading(argument.name), argument.path,
             report.loaded.file.format, duration(report.loaded.seconds));
  print_points(report, out);
  print_bounds(report, out);
  print_surface(report, out);
  print_advice(report, style, out);
  print_map(report, style, out);
}

Json json_organised(const InfoReport& report) {
  if (!report.organised.frame) return nullptr;
  Json json = json_of(report.organised.frame->camera);
  json["residual_px"] = report.organised.residual;
  json["felt_as_frame"] = report.image.depth > 0;
  json["points_felt"] = report.image.points;
  json["radius_m"] = report.image_radius;
  return json;
}

Json json_report(const InfoReport& report) {
  const CloudFile& file = report.loaded.file;
  const PrepareReport& r = report.prepared;
  const auto vector = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  return {{"name", report.loaded.argument.name},
          {"file", report.loaded.argument.path},
          {"format", file.format},
          {"points", file.cloud.size()},
          {"points_declared", file.declared},
          {"points_invalid", file.dropped},
          {"width", file.cloud.width},
          {"height", file.cloud.height},
          {"organised", json_organised(report)},
          {"normals", !file.cloud.normals.empty()},
          {"colors", !file.cloud.colors.empty()},
          {"intensities", !file.cloud.intensities.empty()},
          {"bounds_m",
           {{"lower", vector(report.bounds.lower)}, {"upper", vector(report.bounds.upper)}}},
          {"units",
           {{"guess", report.units.units},
            {"reason", report.units.reason},
            {"advice", report.units.advice}}},
          {"spacing_m",
           {{"nearest_three", report.spacing.nearest_three},
            {"from_area", report.spacing.from_area},
            {"tenth", report.spacing.tenth},
            {"nine_tenths", report.spacing.nine_tenths}}},
          {"noise_m", r.noise},
          {"rim_share", report.rim},
          {"trust", {{"low", r.trust_low}, {"untrusted_share", r.untrusted}}},
          {"advice",
           {{"voxel_m", r.voxel},
            {"radius_m", r.radius},
            {"radius_smallest_m", r.radius_smallest},
            {"radius_largest_m", r.radius_largest},
            {"points_felt", r.points_out}}}};
}

}  // namespace palpate::app
