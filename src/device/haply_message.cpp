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
  static const Json none;
  if (!parent.is_object()) return none;
  const auto found = parent.find(key);
  return found == parent.end() ? none : *found;
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

// One with three buttons and a radio, or one with a cable.
std::uint32_t buttons_of(const Json& frame) {
  std::uint32_t buttons = 0;
  for (const char* kind : {"wireless_verse_grip", "verse_grip"}) {
    const Json& grips = child(frame, kind);
    if (!grips.is_array() || grips.empty()) continue;
    const Json& state = child(grips.front(), "state");
    const std::array pressed = {child(child(state, "buttons"), "a"),
                                child(child(state, "buttons"), "b"),
                                child(child(state, "buttons"), "c")};
    for (std::size_t i = 0; i < pressed.size(); ++i) {
      if (truth(pressed[i]).value_or(false)) buttons |= 1u << i;
    }
    if (truth(child(state, "button")).value_or(false)) buttons |= 1;
  }
  return buttons;
}

HaplyDevice device_of(const Json& told, std::string id, std::uint32_t buttons) {
  HaplyDevice device;
  device.id = std::move(id);
  const Json& state = child(told, "state");
  const std::optional<Vector3d> place = vector(child(state, "cursor_position"), kFarthestHaply);
  const std::optional<Vector3d> velocity = vector(child(state, "cursor_velocity"), kFastestHaply);
  if (place && velocity) device.reading = LinkReading{*place, *velocity, buttons};
  device.calibrated = truth(child(child(told, "status"), "calibrated"));
  device.powered = truth(child(child(told, "status"), "power_supply"));
  return device;
}

}  // namespace

std::vector<HaplyDevice> parse_haply_frame(std::string_view text) {
  const Json frame = Json::parse(text, nullptr, false);
  if (!frame.is_object()) throw Error("what came is no frame of Haply's Inverse Service");
  std::vector<HaplyDevice> devices;
  const Json& told = child(frame, "inverse3");
  if (!told.is_array()) return devices;
  const std::uint32_t buttons = buttons_of(frame);
  for (const Json& each : told) {
    const Json& id = child(each, "device_id");
    if (id.is_string()) devices.push_back(device_of(each, id.get<std::string>(), buttons));
  }
  return devices;
}

std::string haply_greeting() {
  return R"({"session":{"force_render_full_state":{}}})";
}

std::string haply_command(std::string_view id, const Vector3d& force) {
  const Json values = {{"x", force.x()}, {"y", force.y()}, {"z", force.z()}};
  const Json command = {{"device_id", id},
                        {"commands", {{"set_cursor_force", {{"values", values}}}}}};
  return Json{{"inverse3", Json::array({command})}}.dump();
}

}  // namespace palpate::device
