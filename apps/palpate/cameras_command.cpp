#include "apps/palpate/cameras_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/palpate/output.hpp"
#include "apps/palpate/waiting.hpp"
#include "apps/palpate/words.hpp"
#include "palpate/sensor/open_camera.hpp"

namespace palpate::app {

namespace {

constexpr const char* kFooter = R"(Examples:
  palpate cameras
  palpate cameras --json -
  palpate touch camera:simulated:table

Exit codes: 0 done, 1 the list could not be written, 2 the command line is wrong.)";

std::string state_of(const CameraDriver& driver) {
  if (!driver.available) return "not available: " + driver.missing;
  if (driver.name == "sequence") return "available";
  if (driver.devices.empty()) return "available; no camera found";
  return fmt::format("available; {} found", driver.devices.size());
}

void print(const std::vector<CameraDriver>& drivers, std::FILE* stream) {
  const Style style(stream);
  std::size_t width = 0;
  for (const CameraDriver& driver : drivers) {
    for (const CameraDevice& device : driver.devices) width = std::max(width, device.name.size());
  }
  for (const CameraDriver& driver : drivers) {
    fmt::print(stream, "{}  {}\n", style.heading(driver.name), driver.description);
    const std::string state = state_of(driver);
    fmt::print(stream, "  {}\n", driver.available ? state : style.warning(state));
    for (const CameraDevice& device : driver.devices) {
      fmt::print(stream, "  {:<{}}  {}\n", device.name, width, device.description);
    }
  }
}

nlohmann::ordered_json as_json(const CameraDriver& driver) {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  for (const CameraDevice& device : driver.devices) {
    devices.push_back({{"name", device.name}, {"description", device.description}});
  }
  return {{"name", driver.name},
          {"description", driver.description},
          {"available", driver.available},
          {"missing", driver.missing},
          {"devices", devices}};
}

void write_json(const std::vector<CameraDriver>& drivers, const std::string& path) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const CameraDriver& driver : drivers) list.push_back(as_json(driver));
  OutputFile file(path);
  file.write(list.dump(2));
  file.write("\n");
  file.close();
}

}  // namespace

void add_cameras_options(CLI::App& command, CamerasOptions& options) {
  command.add_option("--json", options.json, "the same as data; - is standard output")
      ->type_name("FILE")
      ->group("Output");
  command.footer(kFooter);
}

void cameras(const CamerasOptions& options) {
  const std::vector<CameraDriver> drivers = [] {
    const Waiting waiting("looking for cameras");
    return list_cameras();
  }();
  print(drivers, options.json == "-" ? stderr : stdout);
  if (!options.json.empty()) write_json(drivers, options.json);
}

}  // namespace palpate::app
