// Checks of what is given on the command line.
#include "apps/palpate/cli/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/errors.hpp"

namespace palpate::app {

CLI::Validator number(const std::string& range, std::function<bool(double)> good) {
  const auto check = [range, good = std::move(good)](const std::string& text) -> std::string {
    double value = 0;
    const bool is_number = CLI::detail::lexical_cast(text, value);
    if (is_number && !std::isfinite(value)) {
      return fmt::format("'{}' is not finite; give {}", text, range);
    }
    if (is_number && good(value)) return "";
    return fmt::format("'{}' is not {}", text, range);
  };
  return CLI::Validator(check, "");
}

CLI::Validator positive() {
  return number("a number above 0", [](double x) { return x > 0; });
}

CLI::Validator not_negative() {
  return number("a number of 0 or more", [](double x) { return x >= 0; });
}

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  const auto check = [least, most](const std::string& text) -> std::string {
    std::int64_t value = 0;
    if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return "";
    return fmt::format("'{}' is not a whole number from {} to {}", text, least, most);
  };
  return CLI::Validator(check, "");
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto check = [words](const std::string& text) -> std::string {
    if (std::ranges::find(words, text) != words.end()) return "";
    return fmt::format("'{}' is not one of {}{}", text, fmt::join(words, ", "),
                       did_you_mean(text, words));
  };
  return CLI::Validator(check, "", fmt::format("{}", fmt::join(words, " ")));
}

CLI::Validator parsed_by(std::function<void(const std::string&)> parse) {
  const auto check = [parse = std::move(parse)](const std::string& text) -> std::string {
    try {
      parse(text);
    } catch (const UsageError& error) {
      return without_option(error.what());
    }
    return "";
  };
  return CLI::Validator(check, "");
}

CLI::Option* add_json_option(CLI::App& command, std::string& path) {
  return command.add_option("--json", path, "the same as JSON; - is standard output")
      ->type_name("FILE");
}

}  // namespace palpate::app
