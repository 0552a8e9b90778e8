#include "apps/palpate/option_checks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace palpate::app {

CLI::Validator number(const std::string& range, std::function<bool(double)> good) {
  const auto check = [range, good = std::move(good)](const std::string& text) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && good(value)) return "";
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

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::IsMember(words);
}

std::string wrapped(const std::string& text) {
  constexpr std::size_t kWidth = 66;
  std::string result;
  std::size_t begin = 0;
  while (text.size() - begin > kWidth) {
    const std::size_t space = text.rfind(' ', begin + kWidth);
    if (space == std::string::npos || space <= begin) break;
    result += text.substr(begin, space - begin) + '\n';
    begin = space + 1;
  }
  return result + text.substr(begin);
}

}  // namespace palpate::app
