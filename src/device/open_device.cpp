#include "palpate/device/open_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "device/drivers.hpp"
#include "palpate/base/error.hpp"

namespace palpate {
namespace {

using namespace device;

struct Driver {
  std::string_view name;
  std::unique_ptr<DeviceLink> (*open)(const DeviceName& name, const Clock& clock);
  DriverInfo (*list)();
};

constexpr std::array<Driver, 3> kDrivers = {
    {{"forcedimension", open_forcedimension, forcedimension_driver},
     {"openhaptics", open_openhaptics, openhaptics_driver},
     {"haply", open_haply, haply_driver}}};

const Driver* driver_of(const DeviceName& name) {
  const auto* found = std::ranges::find(kDrivers, name.driver, &Driver::name);
  return found == kDrivers.end() ? nullptr : found;
}

}  // namespace

std::unique_ptr<LinkedDevice> open_device(const std::string& name, WaitingClock& clock,
                                          const LinkedDeviceOptions& options) {
  const DeviceName parsed = parse_device_name(name);
  const Driver* driver = driver_of(parsed);
  if (driver == nullptr) {
    throw Error(
        fmt::format("{}: no such device. Devices are forcedimension[:N], openhaptics[:NAME] and "
                    "haply[:ID]; 'palpate devices' lists those that are there",
                    name));
  }
  return std::make_unique<LinkedDevice>(
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
