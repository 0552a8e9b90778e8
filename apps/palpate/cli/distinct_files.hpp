#pragma once

#include <string>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"

namespace palpate::app {

/// A file that a command names, and by what: "--log", "the cloud 'bunny'".
struct NamedFile {
  std::string name;
  std::string path;  ///< empty: not named; "-" and "synthetic:NAME" are no files
};

/// Files that are read.
[[nodiscard]] std::vector<NamedFile> inputs(const std::vector<CloudArgument>& clouds);

/// @throws UsageError when an output is a file that is read, or that another output goes to as
/// well, links followed. What is no plain file may be written by several.
void check_distinct(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

}  // namespace palpate::app
