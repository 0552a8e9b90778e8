#include "palpate/depth/sensor_profiles.hpp"

#include <array>
#include <string>

#include "palpate/base/error.hpp"

namespace palpate {
namespace {

// From recordings: nss_fast.md section 2. Structured light (the first Kinect, the Xtion) has a
// fixed pattern besides, which is why c stands above what differences of frames give.
constexpr std::array<SensorProfile, 4> kProfiles{{
    {"kinect1", {{0.00039, 0, 0.00093}, 6}},
    {"xtion", {{0.00014, 0, 0.00099}, 6}},
    {"realsense", {{0, 0, 0.00247}, 11}},
    {"tof", {{0, 0, 0.015}, 4.8}},
}};

}  // namespace

std::span<const SensorProfile> sensor_profiles() {
  return kProfiles;
}

const SensorProfile& sensor_profile(std::string_view name) {
  std::string names;
  for (const SensorProfile& profile : kProfiles) {
    if (profile.name == name) return profile;
    if (!names.empty()) names += ", ";
    names += profile.name;
  }
  throw Error("there is no noise profile \"" + std::string(name) + "\"; take one of " + names +
              ", or none: then the noise is measured");
}

NoiseModel unknown_sensor_noise() {
  return {{0.0004, 0, 0.0025}, 6};
}

}  // namespace palpate
