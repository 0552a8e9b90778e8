#include "apps/palpate/options/device_choice.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/names.hpp"
#include "apps/palpate/cli/option_checks.hpp"
#include "apps/palpate/options/touch_options.hpp"
#include "palpate/device/open_device.hpp"

namespace palpate::app {

namespace {

constexpr std::string_view kRemotePath = "remote:";
constexpr const char* kStandOptions = "scale=S, offset=X/Y/Z, frame=CAMERA and clutch=BUTTON";

constexpr std::array<Named<DeviceKind>, 3> kDevices = {{{"scripted", DeviceKind::scripted},
                                                        {"simulated", DeviceKind::simulated},
                                                        {"remote", DeviceKind::remote}}};

void check_paths(const std::vector<DeviceChoice>& devices) {
  std::set<std::string> paths;
  for (const DeviceChoice& device : devices) {
    if (device.is_led() || paths.insert(device.path).second) continue;
    if (device.kind == DeviceKind::hardware) {
      throw UsageError(fmt::format(
          "two hands cannot hold {}; name another device for each ('palpate devices' lists them)",
          device.path));
    }
    throw UsageError(
        fmt::format("two remote devices cannot share {}; give each a path of its own, as in "
                    "--device remote:/tmp/hand",
                    device.path.empty() ? "the usual path" : "'" + device.path + "'"));
  }
}

std::string device_meant_by(const std::string& text) {
  return did_you_mean(
      text.substr(0, text.find_first_of(":,")),
      {"scripted", "simulated", "remote", "forcedimension", "openhaptics", "haply"});
}

// The device without its stand. Drivers say themselves which other options there are.
DeviceChoice kind_of(const std::string& text) {
  if (names_hardware(text)) return {DeviceKind::hardware, text};
  const std::size_t comma = text.find(',');
  if (comma < text.find('=') && text.find('=') != std::string::npos) {
    throw UsageError(fmt::format("'{}' is no option of {}; there are {}", text.substr(comma + 1),
                                 text.substr(0, comma), kStandOptions));
  }
  if (const std::optional<DeviceKind> kind = choice_of(kDevices, text)) return {*kind};
  if (text.starts_with(kRemotePath) && text.size() > kRemotePath.size()) {
    return {DeviceKind::remote, text.substr(kRemotePath.size())};
  }
  throw UsageError(
      fmt::format("'{}' is no device; give scripted, simulated, remote, remote:PATH of a socket, "
                  "or hardware: forcedimension, openhaptics or haply ('palpate devices' looks){}",
                  text, device_meant_by(text)));
}

// Who is led goes where its way is, in the world.
void check_stand(const DeviceChoice& choice) {
  if (!choice.is_led()) return;
  for (const std::string& key : choice.stand.keys) {
    if (key == "scale" && choice.kind == DeviceKind::simulated) continue;
    throw UsageError(
        fmt::format("'{}' is of hands that a person or a program leads (remote, hardware){}; leave "
                    "it out",
                    key, key == "scale" ? ", and of simulated ones" : ""));
  }
}

}  // namespace

DeviceChoice parse_device(const std::string& text) {
  std::string device = text;
  DeviceStand stand = take_stand(device);
  DeviceChoice choice = kind_of(device);
  choice.stand = std::move(stand);
  check_stand(choice);
  return choice;
}

void add_device_option(CLI::App& command, std::vector<std::string>& devices,
                       std::string_view group) {
  command
      .add_option(
          "--device", devices,
          wrapped("scripted: the hand is where the trajectory or exploration says, whatever "
                  "the force; simulated: a hand pulls a device with mass and friction "
                  "there; remote: the hand of another program, which speaks to a socket "
                  "(docs/remote_device.md); forcedimension[:N], openhaptics[:NAME], haply[:ID]: "
                  "hardware "
                  "('palpate devices' lists it; docs/devices.md). Behind the name: ,scale=S "
                  "magnifies its motion; ,offset=X/Y/Z (m) moves its origin; ,frame=CAMERA turns "
                  "its axes as that source's camera looks; ,clutch=BUTTON lets the hand move "
                  "without the tool while it is held. Once for each hand, four at most; with "
                  "several the run is in real time. Default: scripted with --trajectory, else "
                  "simulated"))
      ->check(parsed_by([](const std::string& text) { (void)parse_device(text); }))
      ->type_name("NAME[:PATH][,KEY=VALUE]")
      ->allow_extra_args(false)
      ->group(std::string(group));
}

std::vector<DeviceChoice> choose_devices(const TouchOptions& options) {
  std::vector<DeviceChoice> devices;
  for (const std::string& text : options.devices) devices.push_back(parse_device(text));
  if (!devices.empty()) return devices;
  return {{options.trajectory.empty() ? DeviceKind::simulated : DeviceKind::scripted}};
}

bool need_real_time(const std::vector<DeviceChoice>& devices) {
  return devices.size() > 1 || !devices.front().is_led();
}

void check_devices(const TouchOptions& options) {
  const std::vector<DeviceChoice> devices = choose_devices(options);
  const auto led = std::ranges::count_if(devices, &DeviceChoice::is_led);
  require(devices.size() <= kMostHands, "more than four --device; four hands can touch at once");
  require(!options.simulated_time || !need_real_time(devices),
          "hardware, --device remote and several hands are of real time; leave --simulated-time "
          "out, or "
          "give one scripted or simulated device");
  require(options.trajectory.empty() || led <= 1,
          "a --trajectory leads one hand, and several devices would follow it; leave it out, so "
          "that they explore, or give one scripted or simulated device");
  require(devices.size() == 1 || options.log != "-",
          "each of several hands has a log of its own; --log cannot go to standard output: name a "
          "file");
  check_paths(devices);
  for (const DeviceChoice& device : devices) {
    if (device.stand.frame.empty()) continue;
    (void)camera_named(device.stand.frame, choose_sources(options));
  }
}

}  // namespace palpate::app
