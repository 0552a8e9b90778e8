#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/device/device.hpp"

// Messages between Haply's Inverse Service (3.1 and newer) and its clients: JSON, in metres, metres
// per second and newtons.
namespace palpate::device {

/// State of an Inverse3 in one frame.
struct HaplyDevice {
  std::string id;                           ///< "04EA"
  std::optional<DeviceState> reading = {};  ///< if position and velocity are given, and possible
  std::optional<bool> calibrated = {};      ///< if it is given
  std::optional<bool> powered = {};         ///< if it is given
  bool gripped = false;                     ///< a grip gives its orientation
};

/// Larger numbers are impossible for a hand: m along an axis, and m/s.
inline constexpr double kFarthestHaply = 10;
inline constexpr double kFastestHaply = 100;

/// The devices of a frame; buttons and orientation of the first grip are in all readings.
/// @throws Error when it is not a frame at all.
[[nodiscard]] std::vector<HaplyDevice> parse_haply_frame(std::string_view text);

/// Requests a frame with everything in it.
[[nodiscard]] std::string haply_greeting();

/// Moves the origin of a device's positions from its base to the middle of its reach (the service's
/// preset arm_front_centered).
[[nodiscard]] std::string haply_configuration(std::string_view id);

/// Sets the force on a device, N; answered by a frame. The force stands there twice, as the service
/// of 3.1 calls it (values) and that of 3.5 (vector).
[[nodiscard]] std::string haply_command(std::string_view id, const Eigen::Vector3d& force);

}  // namespace palpate::device
