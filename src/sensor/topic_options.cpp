// Parses the options of topics and bags.
#include "sensor/topic_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "palpate/base/error.hpp"

namespace palpate::sensor {
namespace {

constexpr std::string_view kFrame = ",frame=";
constexpr std::string_view kUnit = ",unit=";
constexpr double kLeastUnit = 1e-9;  // m a step; with kMostUnit as in sequence.json
constexpr double kMostUnit = 1;

double unit_of(std::string_view text, std::string_view form) {
  double unit = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), unit);
  if (error == std::errc() && end == text.data() + text.size() && unit >= kLeastUnit &&
      unit <= kMostUnit) {
    return unit;
  }
  throw Error(fmt::format(
      "unit={} is no unit of depth; write {},unit=METRES with the metres a step, 1e-9 to 1, such "
      "as 0.001 for millimetres",
      text, form));
}

}  // namespace

std::size_t find_options(std::string_view text) {
  return std::min(text.find(kFrame), text.find(kUnit));
}

TopicOptions parse_topic_options(std::string_view options, std::string_view form) {
  TopicOptions parsed;
  while (!options.empty()) {
    const std::string_view option = options.substr(0, options.find(',', 1));
    options.remove_prefix(option.size());
    if (option.starts_with(kFrame) && option.size() > kFrame.size()) {
      parsed.frame = option.substr(kFrame.size());
    } else if (option.starts_with(kUnit)) {
      parsed.unit = unit_of(option.substr(kUnit.size()), form);
    } else {
      throw Error(fmt::format("'{}' is not an option; write {},frame=FRAME or {},unit=METRES",
                              option.substr(1), form, form));
    }
  }
  return parsed;
}

}  // namespace palpate::sensor
