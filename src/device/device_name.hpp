#pragma once

#include <map>
#include <string>
#include <string_view>

namespace palpate::device {

/// "DRIVER[:DEVICE][,KEY=VALUE]...", taken apart.
struct DeviceName {
  std::string driver;
  std::string device;  ///< empty: the first that is there
  std::map<std::string, std::string> options = {};

  /// The value of `key`, or `otherwise` where it is not given.
  [[nodiscard]] std::string option(const std::string& key, const std::string& otherwise = "") const;
};

/// @throws Error when an option has no value or is given twice.
[[nodiscard]] DeviceName parse_device_name(std::string_view name);

/// @throws Error when `name` has options other than `known`, which are named in the message.
void check_options(const DeviceName& name, std::initializer_list<std::string_view> known);

}  // namespace palpate::device
