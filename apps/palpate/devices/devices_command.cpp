#include "apps/palpate/devices/devices_command.hpp"

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/devices/driver_list.hpp"
#include "palpate/device/open_device.hpp"

namespace palpate::app {

namespace {

constexpr const char* kDevicesFooter = R"(Examples:
  palpate devices
  palpate devices --json -
  palpate touch scan.ply --view --device haply

Exit codes: 0 done, 1 the list could not be written, 2 the command line is wrong.)";

// Those that need no hardware.
std::vector<DriverInfo> built_in() {
  return {{.name = "scripted",
           .description = "a hand that goes where it is told, whatever the force",
           .missing = {},
           .devices = {}},
          {.name = "simulated",
           .description = "a device with mass and friction, pulled by a hand",
           .missing = {},
           .devices = {}},
          {.name = "remote",
           .description = "any other program, through a socket (docs/remote_device.md)",
           .missing = {},
           .devices = {}}};
}

}  // namespace

void add_devices_options(CLI::App& command, DevicesOptions& options) {
  add_json_option(command, options.json)->group("Output");
  command.footer(kDevicesFooter);
}

void devices(const DevicesOptions& options) {
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
  if (!options.json.empty()) write_drivers(drivers, options.json);
}

}  // namespace palpate::app
