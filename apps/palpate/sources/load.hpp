#pragma once

#include <string>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/options/source_options.hpp"
#include "palpate/io/read_cloud.hpp"

namespace palpate::app {

/// A cloud that has been read, and how long that took.
struct LoadedCloud {
  CloudArgument argument;
  CloudFile file;
  double seconds = 0;
};

/// Reads one cloud, file, standard input or synthetic, with progress on standard error.
/// @throws Error as read_cloud_file() does, UsageError when options make no sense.
[[nodiscard]] LoadedCloud load(const CloudArgument& argument, const ReadingOptions& options);

}  // namespace palpate::app
