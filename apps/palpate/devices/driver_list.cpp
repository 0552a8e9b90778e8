#include "apps/palpate/devices/driver_list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/palpate/cli/json.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"

namespace palpate::app {

void print_drivers(const std::vector<DriverInfo>& drivers, std::FILE* stream,
                   const std::function<std::string(const DriverInfo&)>& state_of) {
  const Style style(stream);
  std::size_t width = 0;
  for (const DriverInfo& driver : drivers) {
    for (const FoundDevice& device : driver.devices) width = std::max(width, device.name.size());
  }
  for (const DriverInfo& driver : drivers) {
    fmt::print(stream, "{}  {}\n", style.heading(driver.name), driver.description);
    if (driver.available) {
      fmt::print(stream, "  {}\n", state_of(driver));
    } else {
      fmt::print(stream, "  {}\n", style.warning("not available: " + driver.missing));
    }
    for (const FoundDevice& device : driver.devices) {
      fmt::print(stream, "  {:<{}}  {}\n", device.name, width, device.description);
    }
  }
}

std::string found_by(const DriverInfo& driver, std::string_view word) {
  if (driver.devices.empty()) return fmt::format("available; no {} found", word);
  return fmt::format("available; {} found", driver.devices.size());
}

void write_drivers(const std::vector<DriverInfo>& drivers, const std::string& path) {
  Json list = Json::array();
  for (const DriverInfo& driver : drivers) {
    Json devices = Json::array();
    for (const FoundDevice& device : driver.devices) {
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
