// Parses device names, lists drivers and opens a device by name.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "device/drivers.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate {
namespace device {
namespace {

void add_option(DeviceName& name, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string key(text.substr(0, equals));
  const std::string value(equals < text.size() ? text.substr(equals + 1) : "");
  if (key.empty() || value.empty()) {
    throw Error(
        fmt::format("device {}: '{}' is not an option; write KEY=VALUE", name.driver, text));
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

void check_options(const DeviceName& name, std::initializer_list<std::string_view> valid) {
  for (const auto& [key, value] : name.options) {
    if (std::ranges::find(valid, key) != valid.end()) continue;
    throw Error(fmt::format("device {}: unknown option '{}'; the options are {}", name.driver, key,
                            fmt::join(valid, ", ")));
  }
}

}  // namespace device

namespace {

struct Driver {
  std::string_view name;
  std::unique_ptr<DeviceDriver> (*open)(const device::DeviceName& name, const Clock& clock);
  DriverInfo (*list)();
};

constexpr std::array<Driver, 4> kDrivers = {
    {{"forcedimension", device::open_forcedimension, device::list_forcedimension},
     {"openhaptics", device::open_openhaptics, device::list_openhaptics},
     {"haply", device::open_haply, device::list_haply},
     {"ros", device::open_ros, device::list_ros}}};

}  // namespace

std::unique_ptr<ThreadedDevice> open_device(const std::string& name, WaitingClock& clock,
                                            const ThreadedDeviceOptions& options) {
  const device::DeviceName parsed = device::parse_device_name(name);
  const auto* const driver = std::ranges::find(kDrivers, parsed.driver, &Driver::name);
  if (driver == kDrivers.end()) {
    throw Error(
        fmt::format("{}: no such device. Devices are forcedimension[:N], openhaptics[:NAME], "
                    "haply[:ID] and ros:PRESET; 'palpate devices' lists those connected",
                    name));
  }
  return std::make_unique<ThreadedDevice>(
      [driver, parsed, &clock] { return driver->open(parsed, clock); }, clock, options);
}

bool names_hardware(const std::string& name) {
  const std::string driver = name.substr(0, name.find_first_of(":,"));
  return std::ranges::find(kDrivers, driver, &Driver::name) != kDrivers.end();
}

std::vector<DriverInfo> list_devices() {
  std::vector<DriverInfo> drivers;
  for (const Driver& driver : kDrivers) drivers.push_back(driver.list());
  return drivers;
}

}  // namespace palpate
