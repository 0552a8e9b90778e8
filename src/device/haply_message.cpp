// Parses and writes the JSON of Haply's Inverse Service.
#include "device/haply_message.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "palpate/base/error.hpp"

namespace palpate::device {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;

const Json& child(const Json& parent, const char* key) {
  static const Json kAbsent;
  if (!parent.is_object()) return kAbsent;
  const auto found = parent.find(key);
  return found == parent.end() ? kAbsent : *found;
}

std::optional<bool> truth(const Json& value) {
  return value.is_boolean() ? std::optional(value.get<bool>()) : std::nullopt;
}

std::optional<double> number(const Json& value, double largest) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  return std::abs(number) <= largest ? std::optional(number) : std::nullopt;
}

std::optional<Vector3d> vector(const Json& value, double largest) {
  const std::optional<double> x = number(child(value, "x"), largest);
  const std::optional<double> y = number(child(value, "y"), largest);
  const std::optional<double> z = number(child(value, "z"), largest);
  if (!x || !y || !z) return std::nullopt;
  return Vector3d(*x, *y, *z);
}

// Buttons and orientation of the grip in the hand.
struct Grip {
  std::uint32_t buttons = 0;
  std::optional<Eigen::Quaterniond> orientation = {};
};

// nullopt if the value is absent or not a rotation.
std::optional<Eigen::Quaterniond> rotation(const Json& value) {
  constexpr double kLength = 0.01;  // by which a unit quaternion's may be off
  const std::optional<double> w = number(child(value, "w"), 2);
  const std::optional<Vector3d> xyz = vector(value, 2);
  if (!w || !xyz) return std::nullopt;
  const Eigen::Quaterniond read(*w, xyz->x(), xyz->y(), xyz->z());
  if (std::abs(read.norm() - 1) > kLength) return std::nullopt;
  return read.normalized();
}

void add_buttons(const Json& state, std::uint32_t& buttons) {
  const std::array pressed = {child(child(state, "buttons"), "a"),
                              child(child(state, "buttons"), "b"),
                              child(child(state, "buttons"), "c")};
  for (std::size_t i = 0; i < pressed.size(); ++i) {
    if (truth(pressed[i]).value_or(false)) buttons |= 1u << i;
  }
  if (truth(child(state, "button")).value_or(false)) buttons |= 1;
}

// Reads the wireless grip (three buttons) or the one with a cable.
Grip grip_of(const Json& frame) {
  Grip grip;
  for (const char* kind : {"wireless_verse_grip", "verse_grip"}) {
    const Json& grips = child(frame, kind);
    if (!grips.is_array() || grips.empty()) continue;
    const Json& state = child(grips.front(), "state");
    add_buttons(state, grip.buttons);
    if (!grip.orientation) grip.orientation = rotation(child(state, "orientation"));
  }
  return grip;
}

HaplyDevice device_of(const Json& report, std::string id, const Grip& grip) {
  HaplyDevice device;
  device.id = std::move(id);
  const Json& state = child(report, "state");
  const std::optional<Vector3d> position = vector(child(state, "cursor_position"), kFarthestHaply);
  const std::optional<Vector3d> velocity = vector(child(state, "cursor_velocity"), kFastestHaply);
  if (position && velocity) {
    device.reading =
        DeviceState{.position = *position,
                    .velocity = *velocity,
                    .buttons = grip.buttons,
                    .orientation = grip.orientation.value_or(Eigen::Quaterniond::Identity())};
  }
  device.gripped = grip.orientation.has_value();
  device.calibrated = truth(child(child(report, "status"), "calibrated"));
  device.powered = truth(child(child(report, "status"), "power_supply"));
  return device;
}

std::string to_device(std::string_view id, const char* what, const Json& value) {
  const Json device = {{"device_id", id}, {what, value}};
  return Json{{"inverse3", Json::array({device})}}.dump();
}

}  // namespace

std::vector<HaplyDevice> parse_haply_frame(std::string_view text) {
  const Json frame = Json::parse(text, nullptr, false);
  if (!frame.is_object()) throw Error("the message is not a frame of Haply's Inverse Service");
  std::vector<HaplyDevice> devices;
  const Json& reports = child(frame, "inverse3");
  if (!reports.is_array()) return devices;
  const Grip grip = grip_of(frame);
  for (const Json& each : reports) {
    const Json& id = child(each, "device_id");
    if (id.is_string()) devices.push_back(device_of(each, id.get<std::string>(), grip));
  }
  return devices;
}

std::string haply_greeting() {
  return R"({"session":{"force_render_full_state":{}}})";
}

std::string haply_configuration(std::string_view id) {
  return to_device(id, "configure", {{"preset", {{"preset", "arm_front_centered"}}}});
}

std::string haply_command(std::string_view id, const Vector3d& force) {
  const Json xyz = {{"x", force.x()}, {"y", force.y()}, {"z", force.z()}};
  return to_device(id, "commands", {{"set_cursor_force", {{"values", xyz}, {"vector", xyz}}}});
}

}  // namespace palpate::device
