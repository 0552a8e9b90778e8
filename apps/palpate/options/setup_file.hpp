#pragma once

#include "apps/palpate/options/touch_options.hpp"

namespace palpate::app {

/// Notes what the command line has (TouchOptions::given), reads the file that `options.setup`
/// names, if any, and fills in what the command line did not give; `command` is the one that was
/// parsed into `options`. Files in it are relative to its own folder. docs/setup.md describes the
/// file.
/// @throws Error that names file, line and key: of a key that is unknown, a value of another type
/// or out of range, a file that is no TOML.
void apply_setup(const CLI::App& command, TouchOptions& options);

}  // namespace palpate::app
