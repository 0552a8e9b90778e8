#include "apps/palpate/setup_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "apps/palpate/suggestion.hpp"

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

constexpr auto kDetail =
    std::to_array<SetupKey>({{"radius", number}, {"voxel", number}, {"normal_error", number}});

constexpr auto kFrames = std::to_array<SetupKey>({
    {"policy", text},
    {"history", integer},
    {"silence", number},
    {"fade", number},
    {"noise", numbers_or_text},
    {"nearest", number},
    {"farthest", number},
    {"memory", integer},
    {"predict", flag},
    {"fit_everywhere", flag},
    {"clip_to_reach", flag},
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
    {"sharp_edges", flag},
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
    {"device", texts},
    {"trajectory", path},
    {"duration", number},
    {"seed", integer},
    {"rate", number},
});

constexpr auto kGuard = std::to_array<SetupKey>({
    {"maximum_force", number},
    {"slew", number},
    {"watchdog", number},
    {"damping", number},
    {"soft_start", number},
    {"passivity", flag},
});

constexpr auto kServo = std::to_array<SetupKey>({
    {"processor", integer},
    {"realtime", flag},
    {"priority", integer},
    {"lock_memory", flag},
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
