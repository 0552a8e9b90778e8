#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/options/touch_options.hpp"

namespace palpate::app {

/// A source that is to be touched, with all that command line and set-up file say of it.
struct ChosenSource {
  CloudArgument argument;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< T_world_sensor
  SourceChoices choices;
  DescribedOptions described = {};  ///< in its own part of the set-up file
};

/// The set-up file's sources and then those of the command line; one of these that has the name of
/// one of the file's takes its place and keeps its pose and choices. --pose wins over the file.
/// @throws UsageError when there is none, two have one name, or a pose names none of them.
[[nodiscard]] std::vector<ChosenSource> choose_sources(const TouchOptions& options);

}  // namespace palpate::app
