#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/device/device_link.hpp"

// What is said between Haply's Inverse Service (3.1 and newer) and its clients: JSON, in metres,
// metres a second and newtons.
namespace palpate::device {

/// What a frame tells of one Inverse3.
struct HaplyDevice {
  std::string id;                           ///< "04EA"
  std::optional<LinkReading> reading = {};  ///< where place and velocity are told, and possible
  std::optional<bool> calibrated = {};      ///< where it is told
  std::optional<bool> powered = {};         ///< where it is told
  bool gripped = false;                     ///< a grip tells how it is held
};

/// Larger numbers are none of a hand's: m along an axis, and m/s.
inline constexpr double kFarthestHaply = 10;
inline constexpr double kFastestHaply = 100;

/// The devices of a frame; buttons and orientation of the first grip are in all readings.
/// @throws Error when it is no frame at all.
[[nodiscard]] std::vector<HaplyDevice> parse_haply_frame(std::string_view text);

/// Asks for a frame that tells all.
[[nodiscard]] std::string haply_greeting();

/// Lets a device's places be counted from the middle of its reach, not from its base (the service's
/// preset arm_front_centered).
[[nodiscard]] std::string haply_configuration(std::string_view id);

/// Sets the force on a device, N; answered by a frame. The force stands there twice, as the service
/// of 3.1 calls it (values) and that of 3.5 (vector).
[[nodiscard]] std::string haply_command(std::string_view id, const Eigen::Vector3d& force);

}  // namespace palpate::device
