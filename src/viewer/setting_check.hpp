#pragma once

#include <span>
#include <string>

#include "palpate/viewer/setting.hpp"

namespace palpate::viewer {

/// Why `key` cannot be set to `value`, in words; empty: it can.
[[nodiscard]] std::string why_not(std::span<const Setting> settings, const std::string& key,
                                  const SettingValue& value);

}  // namespace palpate::viewer
