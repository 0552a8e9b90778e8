#include "apps/palpate/options/chosen_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

#include "apps/palpate/cli/errors.hpp"

namespace palpate::app {

namespace {

std::vector<ChosenSource> of_setup(const TouchOptions& options) {
  std::vector<ChosenSource> sources;
  for (const SourceSetup& setup : options.setup_sources) {
    sources.push_back({.argument = {setup.name, setup.from},
                       .pose = setup.pose.value_or(Eigen::Isometry3d::Identity()),
                       .choices = setup.choices,
                       .described = setup.described});
  }
  return sources;
}

void name(std::vector<ChosenSource>& sources) {
  std::vector<CloudArgument> arguments;
  for (const ChosenSource& source : sources) arguments.push_back(source.argument);
  name_all(arguments);
  for (std::size_t i = 0; i < sources.size(); ++i) sources[i].argument = arguments[i];
}

// Those of the file that have no name there are called after what they come from before the
// command line is looked at.
void add_command_line(std::vector<ChosenSource>& sources, const TouchOptions& options) {
  const auto of_file = static_cast<std::ptrdiff_t>(sources.size());
  std::set<std::string> replaced;
  for (const std::string& text : options.clouds) {
    const CloudArgument argument = split_argument(text);
    const auto end = sources.begin() + of_file;
    const auto same = std::find_if(sources.begin(), end, [&](const ChosenSource& source) {
      return source.argument.name == argument.name;
    });
    if (same != end && replaced.insert(argument.name).second) {
      same->argument.path = argument.path;
      same->described.clear();  // keys of what it was for need not fit
    } else {
      sources.push_back({.argument = argument,
                         .pose = Eigen::Isometry3d::Identity(),
                         .choices = options.choices});
    }
  }
}

void place(std::vector<ChosenSource>& sources, const std::vector<std::string>& poses) {
  std::set<std::string> placed;
  for (const std::string& text : poses) {
    const PoseArgument pose = parse_pose(text);
    const auto source = std::ranges::find_if(
        sources, [&](const ChosenSource& each) { return each.argument.name == pose.name; });
    if (source == sources.end()) {
      std::string names;
      for (const ChosenSource& each : sources) names += " " + each.argument.name;
      throw UsageError(
          fmt::format("--pose: no source is named '{}'; the names are{}", pose.name, names));
    }
    if (!placed.insert(pose.name).second) {
      throw UsageError(fmt::format("--pose: '{}' has two poses; give one", pose.name));
    }
    source->pose = pose.pose;
  }
}

}  // namespace

std::vector<ChosenSource> choose_sources(const TouchOptions& options) {
  std::vector<ChosenSource> sources = of_setup(options);
  name(sources);
  add_command_line(sources, options);
  name(sources);
  if (sources.empty()) {
    throw UsageError(
        "no sources: name a file, a camera or a sequence; 'palpate touch --help' "
        "tells which there are");
  }
  place(sources, options.poses);
  return sources;
}

}  // namespace palpate::app
