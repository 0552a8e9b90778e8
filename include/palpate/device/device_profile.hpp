#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// What is known of a kind of device. Makers seldom tell all of it: what is unset is not known, and
/// is taken on the safe side by whoever uses it.
struct DeviceProfile {
  std::string name;                         ///< "omega": by which it is asked for
  std::string title;                        ///< "Force Dimension omega.3"
  std::optional<double> maximum_force;      ///< N, that it holds for long
  std::optional<double> peak_force;         ///< N, for a moment
  std::optional<double> maximum_stiffness;  ///< N/m at the hand
  std::optional<double> damping;            ///< viscous, of the device by itself, N s/m
  std::optional<double> coulomb;            ///< dry friction, N
  std::optional<double> mass;               ///< that the hand moves, kg
  std::optional<double> resolution;         ///< of a place, m
  std::optional<double> workspace_radius;   ///< of the largest ball in reach, m
  std::optional<double> rate;               ///< steps a second, Hz
  std::optional<double> delay;              ///< s from the reading of a place to its force's effect
  std::string source;                       ///< where the figures come from
};

/// The kinds that come with palpate, "unknown" first.
[[nodiscard]] const std::vector<DeviceProfile>& device_profiles();

/// The kind of that name.
/// @throws Error that lists what there is.
[[nodiscard]] DeviceProfile device_profile(
    std::string_view name, const std::vector<DeviceProfile>& among = device_profiles());

/// Reads profiles: TOML, a table a kind, keys as the members above in SI units.
/// `what` names the text in messages.
/// @throws Error that says what is wrong, and where.
[[nodiscard]] std::vector<DeviceProfile> parse_device_profiles(std::string_view toml,
                                                               const std::string& what);

/// Reads a file of profiles.
/// @throws Error as parse_device_profiles(), and when the file cannot be read.
[[nodiscard]] std::vector<DeviceProfile> read_device_profiles(const std::string& path);

}  // namespace palpate
