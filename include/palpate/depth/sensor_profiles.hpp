#pragma once

#include <span>
#include <string_view>

#include "palpate/depth/noise_model.hpp"

namespace palpate {

/// What is known of a kind of sensor before its first frame.
struct SensorProfile {
  std::string_view name;  ///< such as "xtion"
  NoiseModel noise;       ///< measured on recordings (nss_fast.md section 2)
};

/// The sensors that there are profiles of: kinect1, xtion, realsense, tof.
[[nodiscard]] std::span<const SensorProfile> sensor_profiles();

/// @throws Error that lists the names when there is no such profile.
[[nodiscard]] const SensorProfile& sensor_profile(std::string_view name);

/// For a sensor of which nothing is known: as noisy as the worse of the common ones within a
/// metre, so that a fit smooths too much rather than too little.
[[nodiscard]] NoiseModel unknown_sensor_noise();

}  // namespace palpate
