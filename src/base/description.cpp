// Checks options by their descriptions.
#include "base/description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "palpate/base/error.hpp"

namespace palpate {

bool Range::contains(double value) const noexcept {
  if (infinity != nullptr && value == std::numeric_limits<double>::infinity()) return true;
  if (!std::isfinite(value)) return false;
  return open ? value > least && value < most : value >= least && value <= most;
}

std::string Range::text() const {
  return words == nullptr ? fmt::format("{} to {}", least, most) : words;
}

void check_number(std::string_view what, const std::string& name, const About& about,
                  double value) {
  const Range& range = about.range;
  if (range.contains(value)) return;
  const std::string unit = *about.unit == '\0' ? "" : fmt::format(" ({})", about.unit);
  const std::string infinity =
      range.infinity == nullptr ? "" : fmt::format(", or infinity for {}", range.infinity);
  throw Error(
      fmt::format("{}: {}{} is {}; give {}{}", what, name, unit, value, range.text(), infinity));
}

void refuse_choice(std::string_view what, const std::string& name,
                   const std::vector<std::string>& names) {
  throw Error(
      fmt::format("{}: {} is unknown or removed; give {}", what, name, fmt::join(names, ", ")));
}

}  // namespace palpate
