#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace palpate::app {

/// A check that says which numbers an option takes.
[[nodiscard]] CLI::Validator number(const std::string& range, std::function<bool(double)> good);
[[nodiscard]] CLI::Validator positive();
[[nodiscard]] CLI::Validator not_negative();
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);

/// Help in lines that fit beside the options' names.
[[nodiscard]] std::string wrapped(const std::string& text);

}  // namespace palpate::app
