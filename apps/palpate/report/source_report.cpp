#include "apps/palpate/report/source_report.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/report/depth_report.hpp"

namespace palpate::app {

namespace {

std::string range(double smallest, double middle, double largest) {
  if (largest <= 1.001 * smallest) return length(middle);
  return fmt::format("{} ({} to {})", length(middle), length(smallest), length(largest));
}

void print_cloud(const TouchedSource& cloud, const Style& style, std::FILE* out) {
  const PrepareReport& r = cloud.prepared;
  fmt::print(out, "{} {} ({})\n", style.heading(cloud.argument.name), cloud.argument.path,
             cloud.format);
  fmt::print(out, "  points     {} read, {} felt", grouped(r.points_in), grouped(r.points_out));
  if (r.duplicates > 0) fmt::print(out, ", {} at the place of another", grouped(r.duplicates));
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
  print_trust(r, out);
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
          {"points_duplicate", r.duplicates},
          {"points_speckle", r.speckle},
          {"spacing_m", r.spacing},
          {"noise_m", r.noise},
          {"voxel_m", r.voxel},
          {"radius_m",
           {{"median", r.radius}, {"smallest", r.radius_smallest}, {"largest", r.radius_largest}}},
          {"trust", {{"low", r.trust_low}, {"untrusted_share", r.untrusted}}},
          {"seconds",
           {{"read", cloud.read_seconds},
            {"prepare", cloud.prepare_seconds},
            {"filter", r.seconds_filter},
            {"index", r.seconds_index},
            {"spacing", r.seconds_spacing},
            {"normals", r.seconds_normals},
            {"weights", r.seconds_weights}}}};
}

}  // namespace

void print_trust(const PrepareReport& prepared, std::FILE* out) {
  if (prepared.untrusted < 0.01) return;
  fmt::print(out,
             "  trust      {:.0f} % of this cloud is not trusted; it is felt as metaball there\n",
             100 * prepared.untrusted);
}

void print_source(const TouchedSource& source, std::FILE* out) {
  const Style style(out);
  if (source.camera) {
    print_camera(source, style, out);
  } else if (source.depth_image) {
    print_depth_image(source, style, out);
  } else {
    print_cloud(source, style, out);
  }
}

Json json_source(const TouchedSource& source) {
  if (source.camera) return json_camera(source);
  return source.depth_image ? json_depth_image(source) : json_cloud(source);
}

}  // namespace palpate::app
