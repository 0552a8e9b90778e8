#include "apps/palpate/doctor/camera_drivers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/palpate/doctor/devices.hpp"

namespace palpate::app::doctor {

namespace {

struct DriverPackages {
  std::string_view driver;
  std::string_view build;    // what a build needs to have the driver
  std::string_view running;  // what a build with it needs
};

constexpr std::array kPackages = {
    DriverPackages{"openni2", "libopenni2-dev", "libopenni2-0"},
    DriverPackages{"freenect", "libfreenect-dev", "libfreenect0.5"},
};

const DriverPackages* packages_of(const std::string& driver) {
  const auto* const found = std::ranges::find(kPackages, driver, &DriverPackages::driver);
  return found == kPackages.end() ? nullptr : found;
}

std::string remedy_for(const System& system, const DriverInfo& driver) {
  const DriverPackages* packages = packages_of(driver.name);
  if (packages == nullptr) return "palpate cameras";
  if (driver.missing.find("this build") != std::string::npos) {
    return fmt::format("sudo apt install {} && cmake --preset release && ninja -C build/release",
                       packages->build);
  }
  if (driver.missing.find("USB") == std::string::npos) {
    return fmt::format("sudo apt install --reinstall {}", packages->running);
  }
  return usb_command(system);
}

// Those that simulate or play are always there.
bool has_hardware(const DriverInfo& driver) {
  return packages_of(driver.name) != nullptr;
}

Finding checked(const System& system, const DriverInfo& driver, bool plugged) {
  Finding finding{"cameras", "driver " + driver.name};
  if (!driver.available) {
    finding.severity = plugged ? Severity::problem : Severity::note;
    finding.words = driver.missing;
    finding.remedy = remedy_for(system, driver);
  } else if (driver.devices.empty() && plugged) {
    finding.severity = Severity::problem;
    finding.words = "a camera for it is plugged in, but it finds none";
    finding.remedy =
        fmt::format("sudo apt install --reinstall {}", packages_of(driver.name)->running);
  } else {
    finding.words = fmt::format("available, {} found", driver.devices.size());
  }
  return finding;
}

}  // namespace

Findings check_camera_drivers(const System& system, const std::vector<Found>& found) {
  Findings findings;
  for (const DriverInfo& driver : system.cameras()) {
    if (!has_hardware(driver)) continue;
    findings.push_back(checked(system, driver, reaches_any(driver.name, found)));
  }
  for (const Found& each : found) {
    if (each.known.kind != DeviceKind::camera || !each.known.reached_by.empty()) continue;
    findings.push_back(
        {"cameras", "driver", Severity::note,
         fmt::format("palpate has no driver for {}; record it as depth images", each.known.name),
         "palpate touch sequence:FOLDER"});
  }
  return findings;
}

}  // namespace palpate::app::doctor
