#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/palpate/output.hpp"
#include "apps/palpate/words.hpp"

namespace palpate::app {

/// Shows drivers (CameraDriver, HapticDriver) with their devices, or what they miss; a driver that
/// is available is followed by what `state_of` says of it.
template <class Driver, class StateOf>
void print_drivers(const std::vector<Driver>& drivers, std::FILE* stream, StateOf state_of) {
  const Style style(stream);
  std::size_t width = 0;
  for (const Driver& driver : drivers) {
    for (const auto& device : driver.devices) width = std::max(width, device.name.size());
  }
  for (const Driver& driver : drivers) {
    fmt::print(stream, "{}  {}\n", style.heading(driver.name), driver.description);
    if (driver.available) {
      fmt::print(stream, "  {}\n", state_of(driver));
    } else {
      fmt::print(stream, "  {}\n", style.warning("not available: " + driver.missing));
    }
    for (const auto& device : driver.devices) {
      fmt::print(stream, "  {:<{}}  {}\n", device.name, width, device.description);
    }
  }
}

/// How many devices a driver has found; `word`: what they are.
template <class Driver>
std::string found_by(const Driver& driver, std::string_view word) {
  if (driver.devices.empty()) return fmt::format("available; no {} found", word);
  return fmt::format("available; {} found", driver.devices.size());
}

/// The same as data, to a file or, as "-", to standard output.
template <class Driver>
void write_drivers(const std::vector<Driver>& drivers, const std::string& path) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Driver& driver : drivers) {
    nlohmann::ordered_json devices = nlohmann::ordered_json::array();
    for (const auto& device : driver.devices) {
      devices.push_back({{"name", device.name}, {"description", device.description}});
    }
    list.push_back({{"name", driver.name},
                    {"description", driver.description},
                    {"available", driver.available},
                    {"missing", driver.missing},
                    {"devices", devices}});
  }
  OutputFile file(path);
  file.write(list.dump(2));
  file.write("\n");
  file.close();
}

}  // namespace palpate::app
