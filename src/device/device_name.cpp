#include "device/device_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

void add_option(DeviceName& name, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string key(text.substr(0, equals));
  const std::string value(equals < text.size() ? text.substr(equals + 1) : "");
  if (key.empty() || value.empty()) {
    throw Error(fmt::format("device {}: '{}' is no option; write KEY=VALUE", name.driver, text));
  }
  if (!name.options.emplace(key, value).second) {
    throw Error(fmt::format("device {}: '{}' is given twice; give it once", name.driver, key));
  }
}

}  // namespace

std::string DeviceName::option(const std::string& key, const std::string& otherwise) const {
  const auto found = options.find(key);
  return found == options.end() ? otherwise : found->second;
}

DeviceName parse_device_name(std::string_view text) {
  DeviceName name;
  std::size_t comma = std::min(text.find(','), text.size());
  const std::string_view head = text.substr(0, comma);
  const std::size_t colon = std::min(head.find(':'), head.size());
  name.driver = head.substr(0, colon);
  name.device = head.substr(std::min(colon + 1, head.size()));
  while (comma < text.size()) {
    const std::size_t end = std::min(text.find(',', comma + 1), text.size());
    add_option(name, text.substr(comma + 1, end - comma - 1));
    comma = end;
  }
  return name;
}

void check_options(const DeviceName& name, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : name.options) {
    if (std::ranges::find(known, key) != known.end()) continue;
    throw Error(fmt::format("device {}: there is no option '{}'; there are {}", name.driver, key,
                            fmt::join(known, ", ")));
  }
}

}  // namespace palpate::device
