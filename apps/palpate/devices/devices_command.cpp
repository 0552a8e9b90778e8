// The commands devices and cameras: list drivers and what is attached.
#include "apps/palpate/devices/devices_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <string_view>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "palpate/base/driver_info.hpp"
#include "palpate/device/hardware.hpp"
#include "palpate/sensor/depth_camera.hpp"

namespace palpate::app {

namespace {

// Drivers with their devices, or what they miss; one that is available is followed by what
// `state_of` reports of it.
void print_drivers(const std::vector<DriverInfo>& drivers, std::FILE* stream,
                   const std::function<std::string(const DriverInfo&)>& state_of) {
  const Style style(stream);
  std::size_t width = 0;
  for (const DriverInfo& driver : drivers) {
    for (const DriverInfo::Device& device : driver.devices)
      width = std::max(width, device.name.size());
  }
  for (const DriverInfo& driver : drivers) {
    fmt::print(stream, "{}  {}\n", style.heading(driver.name), driver.description);
    if (driver.available) {
      fmt::print(stream, "  {}\n", state_of(driver));
    } else {
      fmt::print(stream, "  {}\n", style.warning("not available: " + driver.missing));
    }
    for (const DriverInfo::Device& device : driver.devices) {
      fmt::print(stream, "  {:<{}}  {}\n", device.name, width, device.description);
    }
  }
}

// How many devices a driver has found; `word`: what they are.
std::string found_by(const DriverInfo& driver, std::string_view word) {
  if (driver.devices.empty()) return fmt::format("available; no {} found", word);
  return fmt::format("available; {} found", driver.devices.size());
}

// The same as data.
void write_drivers(const std::vector<DriverInfo>& drivers, const std::string& path) {
  Json list = Json::array();
  for (const DriverInfo& driver : drivers) {
    Json devices = Json::array();
    for (const DriverInfo::Device& device : driver.devices) {
      devices.push_back({{"name", device.name}, {"description", device.description}});
    }
    list.push_back({{"name", driver.name},
                    {"description", driver.description},
                    {"available", driver.available},
                    {"missing", driver.missing},
                    {"devices", devices}});
  }
  write_whole(path, text_of(list));
}

constexpr const char* kCamerasFooter = R"(Examples:
  palpate cameras
  palpate cameras --json -
  palpate touch camera:simulated:table

Exit codes: 0 done, 1 the list could not be written, 2 the command line is wrong.)";

constexpr const char* kDevicesFooter = R"(Examples:
  palpate devices
  palpate devices --json -
  palpate touch scan.ply --view --device haply

Exit codes: 0 done, 1 the list could not be written, 2 the command line is wrong.)";

// Drivers that need no hardware.
std::vector<DriverInfo> built_in() {
  return {
      {.name = "scripted", .description = "follows its trajectory exactly, whatever the force"},
      {.name = "simulated",
       .description = "a device with mass and friction that is pulled along its trajectory"},
      {.name = "remote", .description = "another program, over a socket (docs/remote_device.md)"}};
}

}  // namespace

void add_cameras_options(CLI::App& command, ListOptions& options) {
  add_json_option(command, options.json)->group("Output");
  command.footer(kCamerasFooter);
}

void cameras(const ListOptions& options) {
  const std::vector<DriverInfo> drivers = [] {
    const Waiting waiting("looking for cameras");
    return list_cameras();
  }();
  print_drivers(drivers, options.json == "-" ? stderr : stdout, [](const DriverInfo& driver) {
    return driver.name == "sequence" ? "available" : found_by(driver, "camera");
  });
  write_drivers(drivers, options.json);
}

void add_devices_options(CLI::App& command, ListOptions& options) {
  add_json_option(command, options.json)->group("Output");
  command.footer(kDevicesFooter);
}

void devices(const ListOptions& options) {
  std::vector<DriverInfo> drivers = built_in();
  const std::vector<DriverInfo> hardware = [] {
    const Waiting waiting("looking for haptic devices");
    return list_devices();
  }();
  std::FILE* const stream = options.json == "-" ? stderr : stdout;
  print_drivers(drivers, stream, [](const DriverInfo&) { return "available"; });
  print_drivers(hardware, stream,
                [](const DriverInfo& driver) { return found_by(driver, "device"); });
  drivers.insert(drivers.end(), hardware.begin(), hardware.end());
  write_drivers(drivers, options.json);
}

}  // namespace palpate::app
