#include "viewer/text_messages.hpp"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace palpate::viewer {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;

std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

json json_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

json json_of(const SettingValue& value) {
  return std::visit([](const auto& held) { return json(held); }, value);
}

const char* name_of(SettingKind kind) {
  if (kind == SettingKind::choice) return "choice";
  return kind == SettingKind::on_off ? "switch" : "number";
}

json json_of(const Setting& setting) {
  json result{{"key", setting.key},
              {"label", setting.label},
              {"kind", name_of(setting.kind)},
              {"value", json_of(setting.value)}};
  if (!setting.unit.empty()) result["unit"] = setting.unit;
  if (setting.kind == SettingKind::choice) result["choices"] = setting.choices;
  if (setting.kind == SettingKind::number) {
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
    const Eigen::Vector3d place = source.pose->translation();
    result["pose"] = {{"position", json_of(place)},
                      {"quaternion", json::array({q.x(), q.y(), q.z(), q.w()})}};
  }
  if (source.frustum) {
    result["frustum"] = json::array(
        {source.frustum->tan_half_width, source.frustum->tan_half_height, source.frustum->far});
  }
  return result;
}

const char* name_of(NoticeLevel level) {
  if (level == NoticeLevel::fault) return "fault";
  return level == NoticeLevel::warning ? "warning" : "info";
}

const char* name_of(DeviceStatus status) {
  switch (status) {
    case DeviceStatus::silent:
      return "silent";
    case DeviceStatus::finished:
      return "finished";
    case DeviceStatus::failed:
      return "failed";
    case DeviceStatus::ok:
      break;
  }
  return "ok";
}

}  // namespace

std::string welcome_text(const Welcome& welcome) {
  json message{{"type", "welcome"},         {"version", kVersion},
               {"scene", welcome.scene},    {"origin", json_of(welcome.origin)},
               {"up", json_of(welcome.up)}, {"radius", welcome.radius},
               {"presets", welcome.presets}};
  json& devices = message["devices"] = json::array();
  for (const DeviceLabel& device : welcome.devices) {
    devices.push_back({{"name", device.name}, {"takeable", device.takeable}});
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

std::string sources_text(std::span<const SourceReport> sources) {
  json list = json::array();
  for (const SourceReport& source : sources) list.push_back(json_of(source));
  return text_of({{"type", "sources"}, {"sources", std::move(list)}});
}

std::string notice_text(const Notice& notice) {
  return text_of({{"type", "notice"}, {"level", name_of(notice.level)}, {"text", notice.text}});
}

std::string record_text(bool on, std::string_view file) {
  return text_of({{"type", "record"}, {"on", on}, {"file", file}});
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

std::string_view in_words(const StreamState* stream) {
  return stream == nullptr ? "still" : name_of(stream->phase);
}

}  // namespace palpate::viewer
