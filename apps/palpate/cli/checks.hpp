// Checks of what is given on the command line. CLI11 takes a compiler seconds: headers that name
// its types alone include cli/cli_fwd.hpp.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace palpate::app {

/// Takes finite numbers that are `good`. `range` ends the message: "'x' is not RANGE".
[[nodiscard]] CLI::Validator number(const std::string& range, std::function<bool(double)> good);
[[nodiscard]] CLI::Validator positive();
[[nodiscard]] CLI::Validator not_negative();
[[nodiscard]] CLI::Validator whole_number(std::int64_t least, std::int64_t most);
/// Suggests the word that was meant. Its name is the words, with ' ' between (bash_completion()).
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);

/// A check that takes what `parse` takes, and otherwise reports what its UsageError does.
[[nodiscard]] CLI::Validator parsed_by(std::function<void(const std::string&)> parse);

/// --json of a command whose report can be had as data.
CLI::Option* add_json_option(CLI::App& command, std::string& path);

}  // namespace palpate::app
