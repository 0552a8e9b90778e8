// Options that may differ from source to source.
#include "apps/palpate/options/source_options.hpp"

#include <fmt/format.h>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "depth/description.hpp"
#include "io/input.hpp"
#include "palpate/io/synthetic.hpp"
#include "prepare/description.hpp"
#include "scene/description.hpp"

namespace palpate::app {

namespace {

constexpr Scope kStream{&RunFacts::stream,
                        "applies only to cameras and sequences; no source is one"};
constexpr Scope kImage{&RunFacts::image,
                       "applies only to depth images; clouds do not need it, cameras report their "
                       "own, sequences store it in sequence.json, and bags in their CameraInfo"};
constexpr Scope kDepthUnit{&RunFacts::image,
                           "applies only to depth images; clouds take --scale, cameras report "
                           "their own, sequences store it in sequence.json, and bags and topics "
                           "take ,unit=METRES behind their names"};
constexpr Scope kFiltered{&RunFacts::filtered,
                          "applies only to the depth filter; no source uses it"};
constexpr Scope kFilteredFrames{
    &RunFacts::filtered_frames,
    "applies only to streams that use the depth filter; no source does"};
constexpr Scope kCloud{
    &RunFacts::cloud,
    "applies only to clouds; the depth filter does not use it: remove it, or add --unorganised"};

void add_surface_of_source(OptionTable& table, SourcePlan& s) {
  table.under("Surface (chosen from the data unless given)", "surface", true);
  PrepareOptions& prepare = s.options.prepare;
  table.add(prepare, prepare.radius);
  table.add(prepare, prepare.voxel).only_for(kCloud);
  table.add_key(
      "--normal-error",
      [&s](const double& angle) {
        s.options.prepare.normal_error = angle;
        s.options.depth.normal_error = angle;
      },
      number("an angle from 0.0005 to 0.2 rad", [](double x) { return x >= 5e-4 && x <= 0.2; }));
}

void add_time_of_source(OptionTable& table, PolicyOptions& policy) {
  table.add(policy, policy.policy).only_for(kStream);
  table.add(policy, policy.history)
      .only_for(kStream)
      .only_for({&RunFacts::history,
                 "applies only to the policies average and crossfade; add --policy average"});
  table.add(policy, policy.silence).only_for(kStream);
  table.add(policy, policy.fade).only_for(kStream);
}

void add_depth_filter(OptionTable& table, SourcePlan& s) {
  DepthFilterOptions& depth = s.options.depth;
  table
      .add_text(
          "--noise", KeyKind::numbers_or_text, "S0,S1,S2[,C]",
          [&depth](const std::string& text) { depth.noise = parse_noise(text); },
          described(depth, depth.noise).about.help)
      .only_for({&RunFacts::depth,
                 "applies only to depth images, organised clouds and streams; no source is one"});
  table.add(depth, depth.nearest).only_for(kFiltered);
  table.add(described(depth, depth.farthest), s.farthest).only_for(kFiltered);
  // A block's frames are counted in eight bits.
  table.add(described(depth, depth.memory), depth.memory, whole_number(1, 255))
      .only_for(kFilteredFrames);
  table.add(s.options.policy, s.options.policy.fit_everywhere).only_for(kFilteredFrames);
}

void add_stream_options(OptionTable& table, SourcePlan& s) {
  table.under("Streams", "stream", true);
  add_time_of_source(table, s.options.policy);
  add_depth_filter(table, s);
  table.add(s.options.policy, s.options.policy.clip_to_reach)
      .only_for({&RunFacts::cloud_frames,
                 "applies only to frames processed as clouds; add --unorganised, or remove it: the "
                 "depth filter always limits its costly steps to the tool's reach"});
  table.add_flag("--loop", s.loop, "restart recordings when they end")
      .only_for({&RunFacts::recorded, "applies only to recordings; no source is one"});
}

}  // namespace

std::string cloud_help() {
  std::string names;
  for (const SyntheticName& each : synthetic_names()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", each.name);
  }
  return fmt::format(
      "[NAME=]FILE: a cloud (PLY, PCD, XYZ/TXT/CSV, LAS, LAZ, COPC, E57, Potree 2.0 folders), a "
      "mesh (OBJ, PLY, STL, glTF, GLB), Gaussian splats (PLY, SPZ, .splat) or a depth image (PNG, "
      "PGM), optionally gzipped; - for standard input; or synthetic:NAME with NAME one of {}",
      names);
}

std::vector<CloudArgument> split_scans(const CloudArgument& source, std::size_t most) {
  const std::vector<std::filesystem::path> paths = scans_of(source.path);
  if (paths.size() == 1 || paths.size() > most) return {source};
  std::vector<CloudArgument> scans;
  for (const std::filesystem::path& path : paths) {
    const std::size_t number = io::split_scan(path.string()).number.value_or(0);
    scans.push_back({fmt::format("{}-{}", source.name, number), path.string()});
  }
  return scans;
}

void take_scale(const std::string& text, ReadOptions& options) {
  constexpr const char* kForm =
      "metres a unit, e.g. 0.3048, or 0.3048,1 where heights have another";
  const std::vector<double> scales = parse_numbers(text, 0, "--scale", kForm);
  for (const double scale : scales) {
    if (scale > 0) continue;
    throw UsageError(fmt::format("--scale: {} is not a number above 0; give {}", scale, kForm));
  }
  if (scales.size() > 2) {
    throw UsageError(fmt::format("--scale: '{}' has more than 2 numbers; give {}", text, kForm));
  }
  options.scale = scales.front();
  options.height_scale.reset();
  if (scales.size() > 1) options.height_scale = scales.back();
}

void add_reading_options(OptionTable& table, FileReading& o) {
  table.under("Reading", "reading", true);
  table
      .add_text(
          "--scale", KeyKind::numbers, "FACTOR",
          [&o](const std::string& text) { take_scale(text, o); },
          "metres per unit of the file: 0.001 for millimetres, 0.3048 for feet; 0.3048,1 where "
          "heights are in metres (what the file states; STL and OBJ files that state none and are "
          "1 to 2000 long are taken to be in millimetres)")
      .only_for({&RunFacts::is_static,
                 "applies only to files; cameras report their own, sequences store it in "
                 "sequence.json, and bags and topics take ,unit=METRES behind their names"});
  table
      .add("--length", o.length, "METRES", positive(),
           "length of the cloud's longest side, instead of --scale; splats have no unit of their "
           "own")
      .only_for(kCloud);
  table
      .add("--mesh-spacing", o.mesh_spacing, "METRES", positive(),
           "spacing of the points that the faces of a mesh are sampled into (chosen from its size)")
      .only_for({&RunFacts::is_static, "applies only to files with faces; no source is a file"});
  table
      .add_text(
          "--intrinsics", KeyKind::numbers, "FX,FY,CX,CY",
          [&o](const std::string& text) { o.intrinsics = parse_intrinsics(text); },
          "focal lengths and principal point of a depth image, in pixels; required for depth "
          "images")
      .only_for(kImage);
  table
      .add("--depth-unit", o.depth_unit, "METRES", positive(),
           "metres per unit of a depth image's pixel values (0.001)")
      .only_for(kDepthUnit);
}

namespace {

// Bytes: 500M, 2G.
std::size_t parse_size(std::string text) {
  const std::string given = text;
  try {
    const bool is_size = CLI::AsSizeValue(false)(text).empty();
    if (is_size && text != "0" && !given.starts_with('-')) return std::stoull(text);
  } catch (const CLI::Error&) {
    // It contains less than what follows.
  }
  throw UsageError(fmt::format("--cache: '{}' is no size; give 500M or 2G", given));
}

}  // namespace

void add_cache_option(OptionTable& table, SourcePlan& s) {
  table.under("Reading", "reading", true);
  table
      .add_text(
          "--cache", KeyKind::text, "SIZE",
          [&s](const std::string& text) { s.cache = parse_size(text); },
          "memory for a COPC file or Potree folder; a larger one stays on disk, and what is around "
          "the tools is read: 500M, 2G (1G)")
      .only_for(kCloud);
}

void add_source_options(OptionTable& table, SourcePlan& s) {
  add_reading_options(table, s.reading);
  PrepareOptions& prepare = s.options.prepare;
  table
      .add_text(
          "--viewpoint", KeyKind::numbers, "X,Y,Z",
          [&prepare](const std::string& text) {
            prepare.viewpoint = parse_point(text, "--viewpoint");
            prepare.orientation = PrepareOptions::Orientation::viewpoint;
          },
          described(prepare, prepare.viewpoint).about.help)
      .only_for(kCloud);
  table
      .add_flag("--unorganised", s.as_cloud,
                "process depth images and organised clouds as unorganised points: voxel filter and "
                "fitted normals instead of the depth filter")
      .only_for({&RunFacts::depth,
                 "applies only to depth images, organised clouds and streams; no source is one"});
  add_surface_of_source(table, s);
  add_stream_options(table, s);
}

}  // namespace palpate::app
