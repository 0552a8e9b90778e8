#include "apps/palpate/options/setup_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "apps/palpate/cli/errors.hpp"

namespace palpate::app {

namespace {

// The keys of all parts, one after the other.
template <std::size_t... N>
constexpr auto joined(const std::array<SetupKey, N>&... parts) {
  std::array<SetupKey, (N + ...)> all;
  auto end = all.begin();
  ((end = std::ranges::copy(parts, end).out), ...);
  return all;
}

constexpr auto kReading = std::to_array<SetupKey>({
    {"scale", KeyKind::number},
    {"intrinsics", KeyKind::numbers},
    {"depth_unit", KeyKind::number},
    {"unorganised", KeyKind::flag},
    {"viewpoint", KeyKind::numbers},
});

constexpr auto kDetail = std::to_array<SetupKey>(
    {{"radius", KeyKind::number}, {"voxel", KeyKind::number}, {"normal_error", KeyKind::number}});

constexpr auto kFrameKeys = std::to_array<SetupKey>({
    {"policy", KeyKind::text},
    {"history", KeyKind::integer},
    {"silence", KeyKind::number},
    {"fade", KeyKind::number},
    {"noise", KeyKind::numbers_or_text},
    {"nearest", KeyKind::number},
    {"farthest", KeyKind::number},
    {"memory", KeyKind::integer},
    {"fit_everywhere", KeyKind::flag},
    {"clip_to_reach", KeyKind::flag},
    {"loop", KeyKind::flag},
});

constexpr auto kTime =
    std::to_array<SetupKey>({{"simulated_time", KeyKind::flag}, {"latency", KeyKind::number}});

constexpr auto kField = std::to_array<SetupKey>({
    {"field", KeyKind::text},
    {"preset", KeyKind::text},
    {"kernel", KeyKind::text},
    {"gradient", KeyKind::text},
    {"threshold", KeyKind::number},
    {"tool_radius", KeyKind::number},
    {"sharp_edges", KeyKind::flag},
});

constexpr auto kMaterial = std::to_array<SetupKey>({
    {"stiffness", KeyKind::number},
    {"soft_stiffness", KeyKind::number},
    {"soft_friction", KeyKind::number},
    {"friction_static", KeyKind::number},
    {"friction_dynamic", KeyKind::number},
    {"friction_viscous", KeyKind::number},
    {"texture_amplitude", KeyKind::number},
    {"texture_wavelength", KeyKind::number},
});

constexpr auto kHand = std::to_array<SetupKey>({
    {"device", KeyKind::texts},
    {"trajectory", KeyKind::path},
    {"duration", KeyKind::number},
    {"seed", KeyKind::integer},
    {"rate", KeyKind::number},
});

constexpr auto kGuard = std::to_array<SetupKey>({
    {"maximum_force", KeyKind::number},
    {"slew", KeyKind::number},
    {"watchdog", KeyKind::number},
    {"damping", KeyKind::number},
    {"soft_start", KeyKind::number},
    {"passivity", KeyKind::flag},
});

constexpr auto kServo = std::to_array<SetupKey>({
    {"processor", KeyKind::integer},
    {"realtime", KeyKind::flag},
    {"priority", KeyKind::integer},
    {"lock_memory", KeyKind::flag},
});

constexpr auto kSource = joined(kReading, kDetail, kFrameKeys);
constexpr auto kStream = joined(kFrameKeys, kTime);
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
                                                   {"hand", kHand},
                                                   {"guard", kGuard},
                                                   {"servo", kServo}});

std::vector<std::string> section_names() {
  std::vector<std::string> names;
  for (const Section& each : kSections) names.emplace_back(each.name);
  return names;
}

std::vector<std::string> key_names(std::string_view section) {
  std::vector<std::string> names;
  if (section == "source") names = {"name", "from", "pose"};
  for (const SetupKey& each : keys_of(section)) names.emplace_back(each.key);
  return names;
}

// "did you mean 'radius'? "; empty: nothing is near.
std::string question(std::string_view word, const std::vector<std::string>& names) {
  const std::string near = meant(word, names);
  return near.empty() ? "" : fmt::format("did you mean '{}'? ", near);
}

// "it is one of [hand]; ", where another part has such a key.
std::string elsewhere(std::string_view key) {
  std::vector<std::string> places;
  for (const Section& each : kSections) {
    const std::vector<std::string> names = key_names(each.name);
    if (std::ranges::find(names, key) != names.end()) places.push_back(in_brackets(each.name));
  }
  return places.empty() ? "" : fmt::format("it is one of {}; ", fmt::join(places, ", "));
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

std::string in_brackets(std::string_view section) {
  return section == "source" ? "[[source]]" : fmt::format("[{}]", section);
}

std::string unknown_section(std::string_view section) {
  return fmt::format("'{}' is no part of a set-up; {}its parts are {}", section,
                     question(section, section_names()), fmt::join(section_names(), ", "));
}

std::string unknown_key(std::string_view section, std::string_view key) {
  const std::string there = elsewhere(key);
  return fmt::format("'{}' is no key of {}; {}its keys are {}", key, in_brackets(section),
                     there.empty() ? question(key, key_names(section)) : there,
                     fmt::join(key_names(section), ", "));
}

}  // namespace palpate::app
