#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// The numbers of a kind of device. Makers seldom publish all of them: unset means unknown, and
/// whoever uses it assumes a safe value.
struct DeviceProfile {
  std::string name;                         ///< "omega": for profile=NAME
  std::string title;                        ///< "Force Dimension omega.3"
  std::optional<double> maximum_force;      ///< N, continuous
  std::optional<double> peak_force;         ///< N, for a short time
  std::optional<double> maximum_stiffness;  ///< N/m at the hand
  std::optional<double> damping;            ///< viscous, of the device by itself, N s/m
  std::optional<double> coulomb;            ///< dry friction, N
  std::optional<double> mass;               ///< that the hand moves, kg
  std::optional<double> resolution;         ///< of a position, m
  std::optional<double> workspace_radius;   ///< of the largest ball in reach, m
  std::optional<double> rate;               ///< steps per second, Hz
  std::optional<double> delay;              ///< s from reading a position to its force's effect
  std::string source;                       ///< where the figures come from
};

/// The kinds that come with palpate, "unknown" first.
[[nodiscard]] const std::vector<DeviceProfile>& device_profiles();

/// The kind of that name.
/// @throws Error that lists the kinds.
[[nodiscard]] DeviceProfile device_profile(
    std::string_view name, const std::vector<DeviceProfile>& among = device_profiles());

/// Reads profiles: TOML, one table per kind, with the members above as keys, in SI units.
/// `what`: name of the text in messages.
/// @throws Error that says what is wrong, and where.
[[nodiscard]] std::vector<DeviceProfile> parse_device_profiles(std::string_view toml,
                                                               const std::string& what);

/// Reads a file of profiles.
/// @throws Error as parse_device_profiles(), or when the file cannot be read.
[[nodiscard]] std::vector<DeviceProfile> read_device_profiles(const std::string& path);

}  // namespace palpate
