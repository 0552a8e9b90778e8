#include "apps/palpate/devices/cameras_command.hpp"

#include <CLI/CLI.hpp>

#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/devices/driver_list.hpp"
#include "palpate/sensor/open_camera.hpp"

namespace palpate::app {

namespace {

constexpr const char* kCamerasFooter = R"(Examples:
  palpate cameras
  palpate cameras --json -
  palpate touch camera:simulated:table

Exit codes: 0 done, 1 the list could not be written, 2 the command line is wrong.)";

std::string state_of(const DriverInfo& driver) {
  return driver.name == "sequence" ? "available" : found_by(driver, "camera");
}

}  // namespace

void add_cameras_options(CLI::App& command, CamerasOptions& options) {
  add_json_option(command, options.json)->group("Output");
  command.footer(kCamerasFooter);
}

void cameras(const CamerasOptions& options) {
  const std::vector<DriverInfo> drivers = [] {
    const Waiting waiting("looking for cameras");
    return list_cameras();
  }();
  print_drivers(drivers, options.json == "-" ? stderr : stdout, state_of);
  if (!options.json.empty()) write_drivers(drivers, options.json);
}

}  // namespace palpate::app
