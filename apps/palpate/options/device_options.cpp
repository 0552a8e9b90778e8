// Options that may differ from hand to hand.
#include "apps/palpate/options/device_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/option_table.hpp"
#include "palpate/device/hardware.hpp"

namespace palpate::app {

namespace {

constexpr std::size_t kMostHands = 4;
constexpr double kLargestScale = 1e6;
constexpr int kLastButton = 31;
constexpr const char* kTheCamera = "camera";

double scale_of(const std::string& text) {
  const double scale = parse_numbers(text, 1, "scale", "a number above 0").front();
  if (scale > 0 && scale <= kLargestScale) return scale;
  throw UsageError(fmt::format("scale: {} is out of range; give a number above 0 and at most {}",
                               text, kLargestScale));
}

Eigen::Vector3d offset_of(std::string text) {
  std::ranges::replace(text, '/', ',');
  const std::vector<double> v =
      parse_numbers(text, 3, "offset", "X/Y/Z in metres, e.g. 0/-0.1/0.05");
  return {v[0], v[1], v[2]};
}

int button_of(const std::string& text) {
  const double button = parse_numbers(text, 1, "clutch", "a button number from 0").front();
  if (button >= 0 && button <= kLastButton && std::floor(button) == button) {
    return static_cast<int>(button);
  }
  throw UsageError(
      fmt::format("clutch: {} is not a button number; give one from 0 to {}", text, kLastButton));
}

std::string frame_of(const std::string& text) {
  if (is_name(text)) return text;
  throw UsageError(
      fmt::format("frame: '{}' is not a valid source name; give the name of a camera, or "
                  "frame=camera if there is only one",
                  text));
}

// False: it is no option of a placement.
bool take_one(PlacementOptions& placement, const std::string& key, const std::string& value) {
  if (key == "scale") {
    placement.scale = scale_of(value);
  } else if (key == "offset") {
    placement.offset = offset_of(value);
  } else if (key == "frame") {
    placement.frame = frame_of(value);
  } else if (key == "clutch") {
    placement.clutch = button_of(value);
  } else {
    return false;
  }
  if (std::ranges::find(placement.keys, key) != placement.keys.end()) {
    throw UsageError(fmt::format("'{}' is given twice; give it once", key));
  }
  placement.keys.push_back(key);
  return true;
}

// Takes those options off a device's name and leaves the others.
PlacementOptions parse_placement(std::string& device) {
  PlacementOptions placement;
  std::string rest = device.substr(0, device.find(','));
  for (std::size_t comma = rest.size(); comma < device.size();) {
    const std::size_t end = std::min(device.find(',', comma + 1), device.size());
    const std::string option = device.substr(comma + 1, end - comma - 1);
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string value = option.substr(std::min(equals + 1, option.size()));
    if (!take_one(placement, option.substr(0, equals), value)) rest += "," + option;
    comma = end;
  }
  device = rest;
  return placement;
}

constexpr std::string_view kRemote = "remote";
constexpr std::string_view kRemotePath = "remote:";
constexpr std::string_view kProfile = ",profile=";
constexpr const char* kPlacementOptions = "scale=S, offset=X/Y/Z, frame=CAMERA and clutch=BUTTON";

constexpr std::array<Named<DeviceKind>, 3> kDevices = {{{"scripted", DeviceKind::scripted},
                                                        {"simulated", DeviceKind::simulated},
                                                        {"remote", DeviceKind::remote}}};

// What makers print on their devices.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kProducts = {
    {{"omega", "forcedimension"},
     {"delta", "forcedimension"},
     {"sigma", "forcedimension"},
     {"lambda", "forcedimension"},
     {"falcon", "forcedimension"},
     {"phantom", "openhaptics"},
     {"touch", "openhaptics"},
     {"inverse3", "haply"}}};

std::string device_meant_by(const std::string& text) {
  const std::string word = text.substr(0, text.find_first_of(":,"));
  for (const auto& [product, driver] : kProducts) {
    if (word.starts_with(product)) return fmt::format("; {} is a device of {}", word, driver);
  }
  return did_you_mean(
      word, {"scripted", "simulated", "remote", "forcedimension", "openhaptics", "haply"});
}

// The device without its placement. Drivers list themselves which other options there are.
DevicePlan plan_of(const std::string& text) {
  if (names_hardware(text)) return {DeviceKind::hardware, text};
  if (const std::size_t at = text.find(kProfile);
      at != std::string::npos && text.starts_with(kRemote)) {
    DevicePlan plan = plan_of(text.substr(0, at));
    plan.profile = text.substr(at + kProfile.size());
    return plan;
  }
  const std::size_t comma = text.find(',');
  if (comma < text.find('=') && text.find('=') != std::string::npos) {
    throw UsageError(fmt::format("'{}' is not an option of {}; the options are {}",
                                 text.substr(comma + 1), text.substr(0, comma), kPlacementOptions));
  }
  if (const std::optional<DeviceKind> kind = choice_of(kDevices, text)) return {*kind};
  if (text.starts_with(kRemotePath) && text.size() > kRemotePath.size()) {
    return {DeviceKind::remote, text.substr(kRemotePath.size())};
  }
  throw UsageError(fmt::format(
      "'{}' is not a device; give scripted, simulated, remote, remote:PATH (a socket), or "
      "hardware: forcedimension, openhaptics or haply ('palpate devices' lists it){}",
      text, device_meant_by(text)));
}

// A trajectory is in the world, wherever the device is.
void check_placement(const DevicePlan& device) {
  if (!device.follows_trajectory()) return;
  for (const std::string& key : device.placement.keys) {
    if (key == "scale" && device.kind == DeviceKind::simulated) continue;
    throw UsageError(fmt::format("'{}' works only with {}remote and hardware devices; remove it",
                                 key, key == "scale" ? "simulated, " : ""));
  }
}

bool has_camera(const SourcePlan& source) {
  return source.kind != SourceKind::cloud;
}

}  // namespace

DevicePlan parse_device(const std::string& text) {
  std::string device = text;
  PlacementOptions placement = parse_placement(device);
  DevicePlan plan = plan_of(device);
  plan.placement = std::move(placement);
  check_placement(plan);
  return plan;
}

void add_device_option(OptionTable& table, std::vector<DevicePlan>& devices) {
  table.add_texts(
      "--device", KeyKind::texts, "NAME[:PATH][,KEY=VALUE]",
      [&devices](const std::string& text) { devices.push_back(parse_device(text)); },
      "scripted: follows the trajectory or exploration exactly, whatever the force; simulated: a "
      "device with mass and friction that is pulled along it; remote: another program, over a "
      "socket (docs/remote_device.md); forcedimension[:N], openhaptics[:NAME], haply[:ID]: "
      "hardware ('palpate devices' lists it; docs/devices.md). Options after the name: ,scale=S "
      "scales its motion; ,profile=NAME or FILE.toml: what remote and hardware ones hold; "
      ",offset=X/Y/Z (m) moves its origin; ,frame=CAMERA turns its axes to "
      "that camera (x right, y away from it, z up); ,clutch=BUTTON: while held, the hand moves "
      "without the tool. Repeat for each hand, up to four; several hands run in real time. "
      "Default: scripted with --trajectory, else simulated");
}

bool need_real_time(const std::vector<DevicePlan>& devices) {
  return devices.size() > 1 || !devices.front().follows_trajectory();
}

void check_devices(const std::vector<DevicePlan>& devices) {
  require(devices.size() <= kMostHands,
          "more than four --device options; at most four hands can touch at once, so remove some");
  std::set<std::string> paths;
  for (const DevicePlan& device : devices) {
    if (device.follows_trajectory() || paths.insert(device.path).second) continue;
    if (device.kind == DeviceKind::hardware) {
      throw UsageError(
          fmt::format("two hands cannot share the device {}; name a different one for each "
                      "('palpate devices' lists them)",
                      device.path));
    }
    throw UsageError(
        fmt::format("two remote devices cannot share {}; give each its own path, e.g. --device "
                    "remote:/tmp/hand",
                    device.path.empty() ? "the default path" : "'" + device.path + "'"));
  }
}

std::string camera_named(const std::string& frame, const std::vector<SourcePlan>& sources) {
  std::vector<std::string> cameras;
  for (const SourcePlan& source : sources) {
    if (has_camera(source)) cameras.push_back(source.argument.name);
    if (source.argument.name != frame) continue;
    if (has_camera(source)) return frame;
    throw UsageError(
        fmt::format("--device: frame={}: this source is a cloud without a camera; remove frame= to "
                    "use the world axes",
                    frame));
  }
  if (frame == kTheCamera && cameras.size() == 1) return cameras.front();
  if (cameras.empty()) {
    throw UsageError(fmt::format(
        "--device: frame={}: no source is a camera; remove frame= to use the world axes", frame));
  }
  throw UsageError(fmt::format("--device: frame={}: not the name of one camera; give one of {}",
                               frame, fmt::join(cameras, ", ")));
}

}  // namespace palpate::app
