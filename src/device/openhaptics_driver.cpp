// What there is of 3D Systems' devices: those that the maker's set-up has written down.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/listed.hpp"
#include "device/drivers.hpp"
#include "device/openhaptics_link.hpp"

namespace palpate::device {
namespace {

namespace fs = std::filesystem;

// Where the maker's drivers keep a file NAME.config for each device.
fs::path touch_configurations() {
  const char* given = std::getenv("GTDD_HOME");
  if (given != nullptr && *given != '\0') return fs::path(given) / "config";
  const char* home = std::getenv("HOME");
  return fs::path(home == nullptr ? "" : home) / ".3dsystems" / "config";
}

}  // namespace

DriverInfo openhaptics_driver() {
  DriverInfo driver{.name = "openhaptics",
                    .description =
                        "3D Systems Touch, Touch X; SensAble Phantom Omni, Desktop, "
                        "Premium",
                    .missing = {},
                    .devices = {}};
  return listed(driver, [](DriverInfo& found) {
    const OpenHapticsLibrary library;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(touch_configurations(), none)) {
      if (entry.path().extension() != ".config") continue;
      found.devices.push_back({"openhaptics:" + entry.path().stem().string(),
                               "as set up in " + touch_configurations().string()});
    }
    std::ranges::sort(found.devices, {}, &FoundDevice::name);
  });
}

std::unique_ptr<DeviceLink> open_openhaptics(const DeviceName& name, const Clock& clock) {
  check_options(name, {"library", "profile"});
  return std::make_unique<OpenHapticsLink>(name, clock);
}

}  // namespace palpate::device
