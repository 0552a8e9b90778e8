#include "viewer/client_message.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace palpate::viewer {
namespace {

using nlohmann::json;

constexpr double kLargestId = 9007199254740992.0;  // 2^53
constexpr double kMostDevices = 256;
constexpr double kAllButtons = 4294967295.0;  // 2^32 - 1

/// Thrown in here alone: becomes Unreadable.
struct Unread {
  std::string text;
};

const json& member(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end()) throw Unread{fmt::format("'{}' is missing", name)};
  return *found;
}

double number(const json& value, const char* name, double least, double most) {
  if (!value.is_number()) throw Unread{fmt::format("'{}' is not a number", name)};
  const auto x = value.get<double>();
  if (x >= least && x <= most) return x;
  throw Unread{fmt::format("'{}' is {}; it has to be from {} to {}", name, x, least, most)};
}

double whole(const json& object, const char* name, double most) {
  const double x = number(member(object, name), name, 0, most);
  if (x != std::floor(x)) throw Unread{fmt::format("'{}' is {}, which is not whole", name, x)};
  return x;
}

std::string word(const json& value, const char* name) {
  if (!value.is_string()) throw Unread{fmt::format("'{}' is not a text", name)};
  const auto& text = value.get_ref<const std::string&>();
  if (text.size() > kLongestWord) throw Unread{fmt::format("'{}' is too long", name)};
  return text;
}

bool on(const json& object) {
  const json& value = member(object, "on");
  if (!value.is_boolean()) throw Unread{"'on' is neither true nor false"};
  return value.get<bool>();
}

std::size_t points(const json& object) {
  return static_cast<std::size_t>(whole(object, "points", static_cast<double>(kMostPoints)));
}

std::size_t device(const json& object) {
  return static_cast<std::size_t>(whole(object, "device", kMostDevices - 1));
}

Hand hand(const json& object) {
  const json& place = member(object, "position");
  if (!place.is_array() || place.size() != 3) throw Unread{"'position' is not [x, y, z]"};
  Hand hand;
  hand.device = device(object);
  for (std::size_t i = 0; i < 3; ++i) {
    hand.position[static_cast<Eigen::Index>(i)] =
        number(place[i], "position", -kFarthestHand, kFarthestHand);
  }
  hand.buttons = static_cast<std::uint32_t>(whole(object, "buttons", kAllButtons));
  return hand;
}

Set set(const json& object) {
  const json& value = member(object, "value");
  std::string key = word(member(object, "key"), "key");
  if (value.is_boolean()) return {std::move(key), value.get<bool>()};
  if (value.is_string()) return {std::move(key), word(value, "value")};
  constexpr double kLargest = 1e300;
  return {std::move(key), number(value, "value", -kLargest, kLargest)};
}

ClientMessage read_object(const json& object) {
  const std::string type = word(member(object, "type"), "type");
  if (type == "hand") return hand(object);
  if (type == "ping") return Ping{whole(object, "id", kLargestId)};
  if (type == "hello") return Hello{word(member(object, "token"), "token"), points(object)};
  if (type == "release") return Release{device(object)};
  if (type == "set") return set(object);
  if (type == "preset") return Preset{word(member(object, "name"), "name")};
  if (type == "pause") return Pause{on(object)};
  if (type == "reset") return Reset{};
  if (type == "record") return Record{on(object)};
  if (type == "points") return Points{points(object)};
  throw Unread{"there is no message of this type"};
}

}  // namespace

ClientMessage read_message(std::string_view text) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return Unreadable{"that is no JSON object"};
  try {
    return read_object(object);
  } catch (Unread& unread) {
    return Unreadable{std::move(unread.text)};
  }
}

}  // namespace palpate::viewer
