#include "apps/palpate/report/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app {

void Report::print(std::FILE* out) const {
  const Style style(out);
  fmt::print(out, "{}{}{}\n", style.heading(title_), rest_.empty() ? "" : " ", rest_);
  for (const Line& line : lines_) {
    std::string label = fmt::format("{:<10}", line.label);
    if (line.mark == Mark::warning) label = style.warning(label);
    if (line.mark == Mark::error) label = style.error(label);
    fmt::print(out, "  {} {}\n", label, line.text);
  }
}

std::string and_some(std::size_t count, const char* words) {
  return count == 0 ? "" : fmt::format(", {} {}", grouped(count), words);
}

Json limit(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

}  // namespace palpate::app
