// Parses the JSON that pages send and writes the JSON that they get.
#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "viewer/messages.hpp"

namespace palpate::viewer {

namespace {

using nlohmann::json;

constexpr double kLargestId = 9007199254740992.0;  // 2^53: doubles are exact up to there (derived)
constexpr double kMostDevices = 256;               // devices that a page may name (judgement)
constexpr double kLongestTime = 1e9;               // s (judgement)
constexpr double kSlowest = 0.1;                   // speed of a replay, s/s (judgement)
constexpr double kFastest = 4;                     // speed of a replay, s/s (judgement)
constexpr double kAllButtons = 4294967295.0;       // 2^32 - 1: 32 bits (derived)
constexpr double kLeastForce = 1e-3;               // N of a hand's pull (judgement)
constexpr double kMostForce = 1e3;                 // N of a hand's pull (judgement)
constexpr double kRounding = 1e-3;  // that a quaternion's length may be off by: texts are rounded

// Thrown in here alone: becomes Unreadable.
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
  throw Unread{fmt::format("'{}' is {}; it must be from {} to {}", name, x, least, most)};
}

double whole(const json& object, const char* name, double most) {
  const double x = number(member(object, name), name, 0, most);
  if (x != std::floor(x))
    throw Unread{fmt::format("'{}' is {}, which is not a whole number", name, x)};
  return x;
}

std::string word(const json& value, const char* name) {
  if (!value.is_string()) throw Unread{fmt::format("'{}' is not text", name)};
  const auto& text = value.get_ref<const std::string&>();
  if (text.size() > kLongestWord) throw Unread{fmt::format("'{}' is too long", name)};
  return text;
}

bool on(const json& object) {
  const json& value = member(object, "on");
  if (!value.is_boolean()) throw Unread{"'on' is not true or false"};
  return value.get<bool>();
}

std::size_t points(const json& object) {
  return static_cast<std::size_t>(whole(object, "points", static_cast<double>(kMostPoints)));
}

std::size_t device(const json& object) {
  return static_cast<std::size_t>(whole(object, "device", kMostDevices - 1));
}

Eigen::Quaterniond orientation(const json& object) {
  const json& parts = member(object, "orientation");
  if (!parts.is_array() || parts.size() != 4) throw Unread{"'orientation' is not [x, y, z, w]"};
  Eigen::Quaterniond q;
  for (std::size_t i = 0; i < 4; ++i) {
    q.coeffs()[static_cast<Eigen::Index>(i)] = number(parts[i], "orientation", -2, 2);
  }
  if (std::abs(q.norm() - 1) > kRounding) {
    throw Unread{fmt::format("'orientation' has a length of {}; it must be 1", q.norm())};
  }
  return q.normalized();
}

Eigen::Vector3d place(const json& object, const char* name) {
  const json& parts = member(object, name);
  if (!parts.is_array() || parts.size() != 3) {
    throw Unread{fmt::format("'{}' is not [x, y, z]", name)};
  }
  const auto at = [&](int i) { return number(parts[i], name, -kFarthestHand, kFarthestHand); };
  return {at(0), at(1), at(2)};
}

Hand hand(const json& object) {
  Hand hand;
  hand.target.position = place(object, "position");
  if (object.contains("eye")) hand.eye = place(object, "eye");
  hand.device = device(object);
  hand.target.buttons = static_cast<std::uint32_t>(whole(object, "buttons", kAllButtons));
  if (object.contains("force")) {
    hand.target.maximum_force = number(object["force"], "force", kLeastForce, kMostForce);
  }
  if (object.contains("orientation")) hand.target.orientation = orientation(object);
  if (object.contains("opening")) {
    hand.target.opening = number(object["opening"], "opening", 0, Tool::kLongest);
  }
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
  if (type == "reset")
    return Reset{object.contains("device") ? std::optional(device(object)) : std::nullopt};
  if (type == "record") return Record{on(object)};
  if (type == "seek") return Seek{number(member(object, "time"), "time", 0, kLongestTime)};
  if (type == "play") {
    return Play{on(object), number(member(object, "speed"), "speed", kSlowest, kFastest)};
  }
  if (type == "points") return Points{points(object)};
  throw Unread{"unknown message type"};
}

constexpr int kVersion = 2;

std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

json json_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

json json_of(const Setting::Value& value) {
  return std::visit([](const auto& held) { return json(held); }, value);
}

const char* name_of(Setting::Kind kind) {
  if (kind == Setting::Kind::choice) return "choice";
  return kind == Setting::Kind::on_off ? "switch" : "number";
}

json json_of(const Setting& setting) {
  json result{{"key", setting.key},
              {"label", setting.label},
              {"kind", name_of(setting.kind)},
              {"value", json_of(setting.value)}};
  if (!setting.unit.empty()) result["unit"] = setting.unit;
  if (setting.kind == Setting::Kind::choice) result["choices"] = setting.choices;
  if (setting.restarts) result["restarts"] = true;
  if (!setting.question.empty()) result["question"] = setting.question;
  if (setting.kind == Setting::Kind::number) {
    result["least"] = setting.least;
    result["most"] = setting.most;
    if (setting.step > 0) result["step"] = setting.step;
  }
  return result;
}

json json_of(const SourceReport& source) {
  json result{{"name", source.name},     {"phase", source.phase},     {"rate", source.rate},
              {"points", source.points}, {"latency", source.latency}, {"dropped", source.dropped}};
  if (source.age) result["age"] = *source.age;
  if (source.disagreement) result["disagreement"] = *source.disagreement;
  if (source.pose) {
    const Eigen::Quaterniond q(source.pose->linear());
    const Eigen::Vector3d position = source.pose->translation();
    result["pose"] = {{"position", json_of(position)},
                      {"quaternion", json::array({q.x(), q.y(), q.z(), q.w()})}};
  }
  if (source.frustum) {
    result["frustum"] = json::array(
        {source.frustum->tan_half_width, source.frustum->tan_half_height, source.frustum->far});
  }
  return result;
}

const char* name_of(Viewer::NoticeLevel level) {
  if (level == Viewer::NoticeLevel::fault) return "fault";
  return level == Viewer::NoticeLevel::warning ? "warning" : "info";
}

const char* name_of(DeviceState::Status status) {
  if (status == DeviceState::Status::silent) return "silent";
  if (status == DeviceState::Status::finished) return "finished";
  return status == DeviceState::Status::failed ? "failed" : "ok";
}

}  // namespace

ClientMessage read_message(std::string_view text) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return Unreadable{"the message is not a JSON object"};
  try {
    return read_object(object);
  } catch (Unread& unread) {
    return Unreadable{std::move(unread.text)};
  }
}

std::string welcome_text(const Welcome& welcome) {
  json message{{"type", "welcome"},
               {"version", kVersion},
               {"run", welcome.run},
               {"scene", welcome.scene},
               {"origin", json_of(welcome.origin)},
               {"up", json_of(welcome.up)},
               {"radius", welcome.radius},
               {"presets", welcome.presets}};
  if (welcome.eye) message["eye"] = json_of(*welcome.eye);
  if (welcome.opens > 0) message["opens"] = welcome.opens;
  if (welcome.time_line) message["timeline"] = {{"length", *welcome.time_line}};
  json& devices = message["devices"] = json::array();
  for (const DeviceLabel& device : welcome.devices) {
    devices.push_back(
        {{"name", device.name}, {"takeable", device.takeable}, {"scale", device.scale}});
  }
  json& sources = message["sources"] = json::array();
  for (const SourceLabel& source : welcome.sources) {
    sources.push_back({{"name", source.name}, {"camera", source.camera}});
  }
  json& settings = message["settings"] = json::array();
  for (const Setting& setting : welcome.settings) settings.push_back(json_of(setting));
  return text_of(message);
}

std::string settings_text(std::span<const Setting> settings) {
  json values = json::object();
  for (const Setting& setting : settings) values[setting.key] = json_of(setting.value);
  return text_of({{"type", "settings"}, {"values", std::move(values)}});
}

std::string devices_text(std::span<const DeviceReport> devices) {
  json list = json::array();
  for (const DeviceReport& device : devices) {
    json& report = list.emplace_back(json{{"status", name_of(device.status)}});
    if (!device.reason.empty()) report["reason"] = device.reason;
  }
  return text_of({{"type", "devices"}, {"devices", std::move(list)}});
}

std::string sources_text(std::span<const SourceReport> sources, const std::string& robot) {
  json list = json::array();
  for (const SourceReport& source : sources) list.push_back(json_of(source));
  json message = {{"type", "sources"}, {"sources", std::move(list)}};
  if (!robot.empty()) message["robot"] = robot;
  return text_of(message);
}

std::string notice_text(const Notice& notice) {
  json message{{"type", "notice"}, {"level", name_of(notice.level)}, {"text", notice.text}};
  if (notice.share) message["share"] = *notice.share;
  if (notice.over) message["over"] = true;
  return text_of(message);
}

std::string record_text(bool on, std::string_view file) {
  return text_of({{"type", "record"}, {"on", on}, {"file", file}});
}

std::string moment_text(const TimeLine::Moment& moment) {
  return text_of({{"type", "time"},
                  {"time", moment.time},
                  {"playing", moment.playing},
                  {"speed", moment.speed}});
}

std::string envelope_text(std::span<const float> forces) {
  return text_of({{"type", "envelope"}, {"forces", forces}});
}

std::string refused_text(std::string_view text) {
  return text_of({{"type", "refused"}, {"text", text}});
}

std::string lost_text(std::size_t device, std::string_view why) {
  return text_of({{"type", "lost"}, {"device", device}, {"text", why}});
}

std::string pong_text(double id) {
  return text_of({{"type", "pong"}, {"id", static_cast<std::uint64_t>(id)}});
}

}  // namespace palpate::viewer
