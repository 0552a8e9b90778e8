#include "apps/palpate/setup_keys.hpp"

#include <algorithm>
#include <array>

namespace palpate::app {

namespace {

using enum KeyKind;

// The keys of all parts, one after the other.
template <std::size_t... N>
constexpr auto joined(const std::array<SetupKey, N>&... parts) {
  std::array<SetupKey, (N + ...)> all;
  auto end = all.begin();
  ((end = std::ranges::copy(parts, end).out), ...);
  return all;
}

constexpr auto kReading = std::to_array<SetupKey>({
    {"scale", number},
    {"intrinsics", numbers},
    {"depth_unit", number},
    {"unorganised", flag},
    {"viewpoint", numbers},
});

constexpr auto kDetail = std::to_array<SetupKey>({{"radius", number}, {"voxel", number}});

constexpr auto kFrames = std::to_array<SetupKey>({
    {"policy", text},
    {"history", integer},
    {"silence", number},
    {"fade", number},
    {"noise", numbers_or_text},
    {"loop", flag},
});

constexpr auto kTime = std::to_array<SetupKey>({{"simulated_time", flag}, {"latency", number}});

constexpr auto kField = std::to_array<SetupKey>({
    {"field", text},
    {"preset", text},
    {"kernel", text},
    {"gradient", text},
    {"threshold", number},
    {"tool_radius", number},
    {"one_sided", flag},
});

constexpr auto kMaterial = std::to_array<SetupKey>({
    {"stiffness", number},
    {"soft_stiffness", number},
    {"soft_friction", number},
    {"friction_static", number},
    {"friction_dynamic", number},
    {"friction_viscous", number},
    {"texture_amplitude", number},
    {"texture_wavelength", number},
});

constexpr auto kHand = std::to_array<SetupKey>({
    {"device", text},
    {"trajectory", path},
    {"duration", number},
    {"seed", integer},
    {"rate", number},
});

constexpr auto kSource = joined(kReading, kDetail, kFrames);
constexpr auto kStream = joined(kFrames, kTime);
constexpr auto kSurface = joined(kField, kDetail);

struct Section {
  std::string_view name;
  std::span<const SetupKey> keys;
};

constexpr auto kSections = std::to_array<Section>({{"source", kSource},
                                                   {"reading", kReading},
                                                   {"stream", kStream},
                                                   {"surface", kSurface},
                                                   {"material", kMaterial},
                                                   {"hand", kHand}});

void append(std::string& list, std::string_view name) {
  if (!list.empty()) list += ", ";
  list += name;
}

}  // namespace

std::string option_of(std::string_view key) {
  std::string option = "--" + std::string(key);
  std::ranges::replace(option, '_', '-');
  return option;
}

std::span<const SetupKey> keys_of(std::string_view section) {
  for (const Section& each : kSections) {
    if (each.name == section) return each.keys;
  }
  return {};
}

std::string section_names() {
  std::string list;
  for (const Section& each : kSections) append(list, each.name);
  return list;
}

std::string key_names(std::string_view section) {
  std::string list = section == "source" ? "name, from, pose" : "";
  for (const SetupKey& each : keys_of(section)) append(list, each.key);
  return list;
}

}  // namespace palpate::app
