#include "viewer/setting_check.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace palpate::viewer {
namespace {

std::string why_not(const Setting& setting, double value) {
  if (setting.kind != SettingKind::number) return "it is not a number";
  if (value >= setting.least && value <= setting.most) return {};
  return fmt::format("{} is not from {} to {}", value, setting.least, setting.most);
}

std::string why_not(const Setting& setting, const std::string& value) {
  if (setting.kind != SettingKind::choice) return "it is not a choice";
  if (std::ranges::find(setting.choices, value) != setting.choices.end()) return {};
  return fmt::format("there are only {}", fmt::join(setting.choices, ", "));
}

std::string why_not(const Setting& setting, bool) {
  return setting.kind == SettingKind::on_off ? "" : "it is not a switch";
}

}  // namespace

std::string why_not(std::span<const Setting> settings, const std::string& key,
                    const SettingValue& value) {
  const auto found = std::ranges::find(settings, key, &Setting::key);
  if (found == settings.end()) return "there is no such setting";
  const std::string reason =
      std::visit([&](const auto& given) { return why_not(*found, given); }, value);
  return reason.empty() ? "" : fmt::format("{}: {}", found->label, reason);
}

}  // namespace palpate::viewer
