// Makes the plan of each source from what was chosen for it and for all.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <span>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "io/input.hpp"
#include "palpate/scene/scene.hpp"

namespace palpate::app {

namespace {

namespace fs = std::filesystem;

bool begins_like_an_image(const std::string& path) {
  std::array<char, 4> bytes{};
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  const std::string_view text(bytes.data(), bytes.size());
  return text == "\x89PNG" || (text.starts_with("P5") && std::isspace(bytes[2]) != 0);
}

// Recognises depth images by name or first bytes.
bool is_depth_image(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::string name = io::lower_case(path);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name.ends_with(".png") || name.ends_with(".pgm") || begins_like_an_image(path);
}

// True also for files that do not exist and for pipes.
bool may_be_image(const std::string& path) {
  std::error_code ignored;
  return !path.starts_with(kSynthetic) &&
         (!fs::is_regular_file(path, ignored) || is_depth_image(path));
}

// True also where the header cannot be seen before the file is read.
bool may_be_organised(const std::string& path) {
  std::error_code ignored;
  if (path.starts_with(kSynthetic)) return false;
  if (!fs::is_regular_file(path, ignored) || io::lower_case(path).ends_with(".pcd.gz")) return true;
  std::array<char, 2048> bytes{};
  std::ifstream(path, std::ios::binary).read(bytes.data(), bytes.size());
  const std::string_view head(bytes.data(), bytes.size());
  const std::size_t height = head.find("\nHEIGHT ");
  return height < head.find("\nDATA ") && !head.substr(height).starts_with("\nHEIGHT 1\n");
}

SourceKind kind_of(const std::string& path) {
  if (lives(path)) return SourceKind::stream;
  return is_depth_image(path) ? SourceKind::depth_image : SourceKind::cloud;
}

void name(std::vector<DescribedSource>& sources) {
  std::vector<CloudArgument> arguments;
  for (const DescribedSource& source : sources) arguments.push_back(source.plan.argument);
  name_all(arguments);
  for (std::size_t i = 0; i < sources.size(); ++i) sources[i].plan.argument = arguments[i];
}

// Unnamed sources of the file get the name of their origin first, so that the command line can
// name them.
void add_command_line(std::vector<DescribedSource>& sources, const TouchChoices& choices) {
  const auto of_file = static_cast<std::ptrdiff_t>(sources.size());
  std::set<std::string> replaced;
  for (const std::string& text : choices.sources) {
    const CloudArgument argument = split_argument(text);
    const auto end = sources.begin() + of_file;
    const auto same = std::find_if(sources.begin(), end, [&](const DescribedSource& source) {
      return source.plan.argument.name == argument.name;
    });
    if (same != end && replaced.insert(argument.name).second) {
      same->plan.argument.path = argument.path;
      same->described.clear();  // keys of what it was for need not fit
    } else {
      sources.push_back({.plan = choices.every_source});
      sources.back().plan.argument = argument;
    }
  }
}

auto named(std::vector<DescribedSource>& sources, const std::string& name) {
  return std::ranges::find(sources, name, [](const DescribedSource& each) -> const std::string& {
    return each.plan.argument.name;
  });
}

void place(std::vector<DescribedSource>& sources, std::span<const PoseArgument> poses) {
  std::set<std::string> placed;
  for (const PoseArgument& pose : poses) {
    const auto source = named(sources, pose.name);
    if (source == sources.end()) {
      std::string names;
      for (const DescribedSource& each : sources) names += " " + each.plan.argument.name;
      throw UsageError(
          fmt::format("--pose: no source is named '{}'; the names are{}", pose.name, names));
    }
    if (!placed.insert(pose.name).second) {
      throw UsageError(fmt::format("--pose: '{}' has two poses; give one", pose.name));
    }
    source->plan.options.T_world_sensor = pose.pose;
  }
}

// Makes each scan of a file a source of its own, as far as a scene has room for them.
std::vector<DescribedSource> scans_apart(const std::vector<DescribedSource>& sources) {
  std::size_t room = Scene::kMaxSources - std::min(Scene::kMaxSources, sources.size());
  std::vector<DescribedSource> result;
  for (const DescribedSource& source : sources) {
    const std::vector<CloudArgument> scans = split_scans(source.plan.argument, room + 1);
    room -= scans.size() - 1;
    for (const CloudArgument& scan : scans) {
      result.push_back(source);
      result.back().plan.argument = scan;
    }
  }
  name(result);
  return result;
}

// A pose of a file is of all its scans, unless one has a pose of its own.
void place_and_split(std::vector<DescribedSource>& sources, std::vector<PoseArgument> poses) {
  const auto of_scans = std::stable_partition(
      poses.begin(), poses.end(),
      [&](const PoseArgument& pose) { return named(sources, pose.name) != sources.end(); });
  place(sources, std::span(poses.begin(), of_scans));
  sources = scans_apart(sources);
  place(sources, std::span(of_scans, poses.end()));
}

// A tool of that size can be felt with no smaller R, m.
void check_radius(const PrepareOptions& prepare, double tool_radius) {
  if (!prepare.radius || *prepare.radius >= prepare.minimum_radius) return;
  throw UsageError(
      fmt::format("--radius {} is too small for --tool-radius {}; give at least {:.4g}",
                  *prepare.radius, tool_radius, prepare.minimum_radius));
}

void check_range(const DepthFilterOptions& depth) {
  if (depth.nearest < depth.farthest) return;
  throw UsageError(fmt::format(
      "--nearest {} is not below --farthest {}; give a smaller --nearest or a larger --farthest",
      depth.nearest, depth.farthest));
}

// Applies source kind and shared surface options to one SourcePlan.
void complete(SourcePlan& source, const SurfacePlan& surface) {
  constexpr double kToolInR = 0.3;  // a tool's radius in the smallest R that it can feel
  source.kind = kind_of(source.argument.path);
  PrepareOptions& prepare = source.options.prepare;
  prepare.minimum_radius = surface.field.tool_radius / kToolInR;
  prepare.kernel = surface.field.kernel;
  prepare.paper = surface.paper;
  prepare.material_from_intensity = surface.soft_stiffness || surface.soft_friction;
  check_radius(prepare, surface.field.tool_radius);
  DepthFilterOptions& depth = source.options.depth;
  depth.farthest = source.farthest.value_or(depth.farthest);
  check_range(depth);
  source.as_cloud = source.as_cloud || surface.paper;
  require(!source.reading.length || !source.reading.scale,
          "--length chooses the scale; remove --scale or --length");
  std::optional<Policy>& policy = source.options.policy.policy;
  require(policy != Policy::morph || !source.as_cloud,
          "--policy morph needs organised depth images; remove --unorganised and --preset paper, "
          "or choose another policy");
  source.options.organised = !source.as_cloud;
  if (!policy && surface.paper) policy = Policy::average;
}

}  // namespace

std::vector<DescribedSource> choose_sources(const TouchChoices& choices,
                                            const SurfacePlan& surface) {
  std::vector<DescribedSource> sources = choices.described_sources;
  name(sources);
  add_command_line(sources, choices);
  name(sources);
  require(
      !sources.empty(),
      "no source given; name a file, a camera or a sequence ('palpate touch --help' lists them)");
  place_and_split(sources, choices.poses);
  for (DescribedSource& source : sources) complete(source.plan, surface);
  return sources;
}

Policy policy_of(const SourcePlan& source) {
  return source.options.policy.policy.value_or(source.as_cloud ? kCloudPolicy : kDepthPolicy);
}

bool keeps_history(Policy policy) {
  return policy == Policy::average || policy == Policy::crossfade;
}

void add_facts(RunFacts& facts, const SourcePlan& source) {
  const std::string path = file_of(source.argument.path);
  const bool stream = source.kind == SourceKind::stream;
  const bool organised = source.kind == SourceKind::cloud && may_be_organised(path);
  const bool depth = source.kind != SourceKind::cloud || organised;
  const bool cloud = !depth || organised || source.as_cloud;
  facts.stream |= stream;
  facts.is_static |= !stream;
  facts.recorded |=
      stream && !path.starts_with(kRos) && (!path.starts_with(kCamera) || path.ends_with(".oni"));
  facts.image |= !stream && may_be_image(path);
  facts.depth |= depth;
  facts.filtered |= depth && !source.as_cloud;
  facts.filtered_frames |= stream && !cloud;
  facts.cloud |= cloud;
  facts.cloud_frames |= stream && cloud;
  facts.history |= stream && keeps_history(policy_of(source));
}

}  // namespace palpate::app
