#include "apps/palpate/setup_keys.hpp"

#include <array>

namespace palpate::app {

namespace {

constexpr std::array<SetupKey, 4> kReading = {{
    {"scale", "--scale", KeyKind::number},
    {"intrinsics", "--intrinsics", KeyKind::numbers},
    {"depth_unit", "--depth-unit", KeyKind::number},
    {"unorganised", "--unorganised", KeyKind::flag},
}};

constexpr std::array<SetupKey, 8> kStream = {{
    {"policy", "--policy", KeyKind::text},
    {"history", "--history", KeyKind::integer},
    {"silence", "--silence", KeyKind::number},
    {"fade", "--fade", KeyKind::number},
    {"noise", "--noise", KeyKind::numbers_or_text},
    {"loop", "--loop", KeyKind::flag},
    {"simulated_time", "--simulated-time", KeyKind::flag},
    {"latency", "--latency", KeyKind::number},
}};

constexpr std::array<SetupKey, 9> kSurface = {{
    {"field", "--field", KeyKind::text},
    {"preset", "--preset", KeyKind::text},
    {"kernel", "--kernel", KeyKind::text},
    {"gradient", "--gradient", KeyKind::text},
    {"radius", "--radius", KeyKind::number},
    {"voxel", "--voxel", KeyKind::number},
    {"threshold", "--threshold", KeyKind::number},
    {"tool_radius", "--tool-radius", KeyKind::number},
    {"one_sided", "--one-sided", KeyKind::flag},
}};

constexpr std::array<SetupKey, 8> kMaterial = {{
    {"stiffness", "--stiffness", KeyKind::number},
    {"soft_stiffness", "--soft-stiffness", KeyKind::number},
    {"soft_friction", "--soft-friction", KeyKind::number},
    {"friction_static", "--friction-static", KeyKind::number},
    {"friction_dynamic", "--friction-dynamic", KeyKind::number},
    {"friction_viscous", "--friction-viscous", KeyKind::number},
    {"texture_amplitude", "--texture-amplitude", KeyKind::number},
    {"texture_wavelength", "--texture-wavelength", KeyKind::number},
}};

constexpr std::array<SetupKey, 5> kHand = {{
    {"device", "--device", KeyKind::text},
    {"trajectory", "--trajectory", KeyKind::path},
    {"duration", "--duration", KeyKind::number},
    {"seed", "--seed", KeyKind::integer},
    {"rate", "--rate", KeyKind::number},
}};

constexpr std::array<SetupKey, 13> kSource = {{
    {"scale", "--scale", KeyKind::number},
    {"intrinsics", "--intrinsics", KeyKind::numbers},
    {"depth_unit", "--depth-unit", KeyKind::number},
    {"unorganised", "--unorganised", KeyKind::flag},
    {"viewpoint", "--viewpoint", KeyKind::numbers},
    {"radius", "--radius", KeyKind::number},
    {"voxel", "--voxel", KeyKind::number},
    {"policy", "--policy", KeyKind::text},
    {"history", "--history", KeyKind::integer},
    {"silence", "--silence", KeyKind::number},
    {"fade", "--fade", KeyKind::number},
    {"noise", "--noise", KeyKind::numbers_or_text},
    {"loop", "--loop", KeyKind::flag},
}};

struct Section {
  std::string_view name;
  std::span<const SetupKey> keys;
};

constexpr std::array<Section, 6> kSections = {{{"source", kSource},
                                               {"reading", kReading},
                                               {"stream", kStream},
                                               {"surface", kSurface},
                                               {"material", kMaterial},
                                               {"hand", kHand}}};

void append(std::string& list, std::string_view name) {
  if (!list.empty()) list += ", ";
  list += name;
}

}  // namespace

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
