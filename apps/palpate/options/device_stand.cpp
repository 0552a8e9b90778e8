#include "apps/palpate/options/device_stand.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/options/depth_file.hpp"

namespace palpate::app {

namespace {

constexpr double kLargestScale = 1e6;
constexpr int kLastButton = 31;
constexpr const char* kTheCamera = "camera";

double scale_of(const std::string& text) {
  const double scale = parse_numbers(text, 1, "scale", "a number above 0").front();
  if (scale > 0 && scale <= kLargestScale) return scale;
  throw UsageError(
      fmt::format("scale: {} is out of range; write a number above 0, to {}", text, kLargestScale));
}

Eigen::Vector3d offset_of(std::string text) {
  std::ranges::replace(text, '/', ',');
  const std::vector<double> v =
      parse_numbers(text, 3, "offset", "X/Y/Z in metres, such as 0/-0.1/0.05");
  return {v[0], v[1], v[2]};
}

int button_of(const std::string& text) {
  const double button = parse_numbers(text, 1, "clutch", "a button's number, from 0").front();
  if (button >= 0 && button <= kLastButton && std::floor(button) == button) {
    return static_cast<int>(button);
  }
  throw UsageError(
      fmt::format("clutch: {} is no button; write its number, 0 to {}", text, kLastButton));
}

std::string frame_of(const std::string& text) {
  if (is_name(text)) return text;
  throw UsageError(
      fmt::format("frame: '{}' is no source's name; write that of a camera, or frame=camera where "
                  "there is one",
                  text));
}

// False: it is no option of a stand.
bool take_one(DeviceStand& stand, const std::string& key, const std::string& value) {
  if (key == "scale") {
    stand.scale = scale_of(value);
  } else if (key == "offset") {
    stand.offset = offset_of(value);
  } else if (key == "frame") {
    stand.frame = frame_of(value);
  } else if (key == "clutch") {
    stand.clutch = button_of(value);
  } else {
    return false;
  }
  if (std::ranges::find(stand.keys, key) != stand.keys.end()) {
    throw UsageError(fmt::format("'{}' is given twice; give it once", key));
  }
  stand.keys.push_back(key);
  return true;
}

bool has_camera(const ChosenSource& source) {
  return lives(source.argument.path) || is_depth_image(source.argument.path);
}

// A device's x goes to the right, y away and z up; a picture's to the right, down and away.
Eigen::Matrix3d behind(const Eigen::Isometry3d& T_world_camera) {
  const Eigen::Matrix3d picture = T_world_camera.linear();
  Eigen::Matrix3d axes;
  axes << picture.col(0), picture.col(2), -picture.col(1);
  return axes;
}

}  // namespace

DeviceStand take_stand(std::string& device) {
  DeviceStand stand;
  std::string rest = device.substr(0, device.find(','));
  for (std::size_t comma = rest.size(); comma < device.size();) {
    const std::size_t end = std::min(device.find(',', comma + 1), device.size());
    const std::string option = device.substr(comma + 1, end - comma - 1);
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string value = option.substr(std::min(equals + 1, option.size()));
    if (!take_one(stand, option.substr(0, equals), value)) rest += "," + option;
    comma = end;
  }
  device = rest;
  return stand;
}

std::string camera_named(const std::string& frame, const std::vector<ChosenSource>& sources) {
  std::vector<std::string> cameras;
  for (const ChosenSource& source : sources) {
    if (has_camera(source)) cameras.push_back(source.argument.name);
    if (source.argument.name != frame) continue;
    if (has_camera(source)) return frame;
    throw UsageError(
        fmt::format("--device: frame={}: it is a cloud, which no camera looks at; leave it out for "
                    "the world's axes",
                    frame));
  }
  if (frame == kTheCamera && cameras.size() == 1) return cameras.front();
  if (cameras.empty()) {
    throw UsageError(fmt::format(
        "--device: frame={}: there is no camera; leave it out for the world's axes", frame));
  }
  throw UsageError(fmt::format("--device: frame={}: name one of the cameras: {}", frame,
                               fmt::join(cameras, ", ")));
}

void apply(const DeviceStand& stand, const std::string& camera, const Scene& scene,
           Workspace& workspace) {
  Eigen::Isometry3d& pose = workspace.T_world_device;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Source& source = scene.source(i);
    if (!camera.empty() && source.name() == camera) pose.linear() = behind(source.pose());
  }
  pose.translation() += pose.linear() * stand.offset;
}

}  // namespace palpate::app
