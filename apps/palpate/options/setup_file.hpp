#pragma once

#include <string>

#include "apps/palpate/options/touch_options.hpp"

namespace palpate::app {

/// Reads a set-up file into `choices`, to which the options of `table` are bound, and fills in what
/// the command line did not give; notes which keys it has. Files in it are relative to its own
/// folder. docs/setup.md describes the file.
/// @throws Error that names file, line and key: of a key that is unknown, a value of another type
/// or out of range, a file that is no TOML.
void read_setup(const std::string& path, const OptionTable& table, const GivenOptions& given,
                TouchChoices& choices, DescribedOptions& described);

}  // namespace palpate::app
