// Reads profiles of devices from TOML and finds one by its name.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>

#include "device/drivers.hpp"
#include "palpate/base/error.hpp"
#include "palpate/device/device.hpp"

namespace palpate {
namespace device {

// profiles.toml, as it was when this was built; CMake writes the source of this.
std::string_view profiles_text();

DeviceInfo info_of(const DeviceProfile& profile, const std::string& name) {
  DeviceInfo info;
  info.name = name;
  info.maximum_force = profile.maximum_force.value_or(*device_profile("unknown").maximum_force);
  take_motion(profile, info);
  return info;
}

void add_motors(DeviceInfo& info, const DeviceProfile& profile, bool wrist, bool gripper) {
  const DeviceProfile unknown = device_profile("unknown");
  if (wrist) info.maximum_torque = profile.maximum_torque.value_or(*unknown.maximum_torque);
  if (gripper) info.maximum_grip = profile.maximum_grip.value_or(*unknown.maximum_grip);
}

}  // namespace device

namespace {

// A number of a profile: its key, and the least that it may be.
struct NumberKey {
  std::string_view key;
  std::optional<double> DeviceProfile::*member;
  bool positive;
};

constexpr std::array<NumberKey, 13> kNumbers = {{
    {"maximum_force", &DeviceProfile::maximum_force, true},
    {"peak_force", &DeviceProfile::peak_force, true},
    {"maximum_stiffness", &DeviceProfile::maximum_stiffness, true},
    {"maximum_torque", &DeviceProfile::maximum_torque, true},
    {"maximum_grip", &DeviceProfile::maximum_grip, true},
    {"angular_damping", &DeviceProfile::angular_damping, false},
    {"damping", &DeviceProfile::damping, false},
    {"coulomb", &DeviceProfile::coulomb, false},
    {"mass", &DeviceProfile::mass, true},
    {"resolution", &DeviceProfile::resolution, false},
    {"workspace_radius", &DeviceProfile::workspace_radius, true},
    {"rate", &DeviceProfile::rate, true},
    {"delay", &DeviceProfile::delay, false},
}};

// Reads one table after the other; messages name the text and the line.
class Reader {
 public:
  explicit Reader(const std::string& what) : what_(what) {}

  [[nodiscard]] std::vector<DeviceProfile> read(std::string_view text) const {
    std::vector<DeviceProfile> profiles;
    for (const auto& [key, node] : parse(text)) {
      const toml::table* table = node.as_table();
      if (table == nullptr) {
        fail(key.source(),
             fmt::format("'{}' is not a table; write [NAME] with its keys on the lines below",
                         key.str()));
      }
      profiles.push_back(profile(std::string(key.str()), *table));
    }
    return profiles;
  }

 private:
  [[noreturn]] void fail(const toml::source_region& where, const std::string& wrong) const {
    throw Error(fmt::format("{}, line {}: {}", what_, where.begin.line, wrong));
  }

  [[nodiscard]] toml::table parse(std::string_view text) const {
    try {
      return toml::parse(text, what_);
    } catch (const toml::parse_error& error) {
      fail(error.source(), std::string(error.description()));
    }
  }

  [[nodiscard]] DeviceProfile profile(std::string name, const toml::table& table) const {
    DeviceProfile profile;
    profile.title = name;
    profile.name = std::move(name);
    for (const auto& [key, node] : table) {
      if (key.str() == "title") {
        profile.title = text(key, node);
      } else if (key.str() == "source") {
        profile.source = text(key, node);
      } else {
        const NumberKey& found = number_key(key);
        profile.*found.member = number(found, node);
      }
    }
    return profile;
  }

  [[nodiscard]] std::string text(const toml::key& key, const toml::node& node) const {
    if (!node.is_string())
      fail(node.source(), fmt::format("'{}' is not text in quotes", key.str()));
    return *node.value<std::string>();
  }

  [[nodiscard]] const NumberKey& number_key(const toml::key& key) const {
    const auto* found = std::ranges::find(kNumbers, key.str(), &NumberKey::key);
    if (found != kNumbers.end()) return *found;
    std::string keys = "title, source";
    for (const NumberKey& each : kNumbers) keys += fmt::format(", {}", each.key);
    fail(key.source(),
         fmt::format("'{}' is not a key of a device; the keys are {}", key.str(), keys));
  }

  [[nodiscard]] double number(const NumberKey& key, const toml::node& node) const {
    const std::optional<double> value = node.value<double>();
    const bool good =
        node.is_number() && std::isfinite(*value) && (key.positive ? *value > 0 : *value >= 0);
    if (good) return *value;
    fail(node.source(), fmt::format("'{}' is not a number {}", key.key,
                                    key.positive ? "above 0" : "of 0 or more"));
  }

  const std::string& what_;
};

}  // namespace

std::vector<DeviceProfile> parse_device_profiles(std::string_view toml, const std::string& what) {
  return Reader(what).read(toml);
}

std::vector<DeviceProfile> read_device_profiles(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad()) {
    throw Error(fmt::format("{}: cannot be read; name a file of device profiles", path));
  }
  return parse_device_profiles(text, path);
}

const std::vector<DeviceProfile>& device_profiles() {
  static const std::vector<DeviceProfile> kProfiles = [] {
    std::vector<DeviceProfile> all = parse_device_profiles(device::profiles_text(), "profiles");
    std::stable_partition(all.begin(), all.end(),
                          [](const DeviceProfile& each) { return each.name == "unknown"; });
    return all;
  }();
  return kProfiles;
}

DeviceProfile device_profile(std::string_view name, const std::vector<DeviceProfile>& among) {
  const auto found = std::ranges::find(among, name, &DeviceProfile::name);
  if (found != among.end()) return *found;
  if (name.ends_with(".toml")) {
    const std::vector<DeviceProfile> own = read_device_profiles(std::string(name));
    if (own.size() == 1) return own.front();
    throw Error(fmt::format("{}: it has {} profiles; leave the device's alone", name, own.size()));
  }
  std::string names;
  for (const DeviceProfile& each : among) names += (names.empty() ? "" : ", ") + each.name;
  throw Error(fmt::format(
      "unknown device profile '{}'; the profiles are {}, and files of your own: NAME.toml", name,
      names));
}

}  // namespace palpate
