#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::io {

/// The columns of a trajectory that say how a tool is held.
struct HeldColumns {
  std::array<std::size_t, 4> slots{};  ///< of x, y, z, w, or of roll, pitch, yaw
  bool angles = false;
  double unit = 1;      ///< rad a step of an angle
  bool stated = false;  ///< a name states that unit
  std::string words{};  ///< what names were taken for what; empty: qx, qy, qz, qw

  [[nodiscard]] std::span<const std::size_t> used() const {
    return std::span(slots).first(angles ? 3 : 4);
  }
  /// What numbers in these columns say: unit length is not made sure of; angles turn about the
  /// fixed axes x, y and z, one after the other, as ROS has them.
  [[nodiscard]] Eigen::Quaterniond orientation(const std::array<double, 4>& numbers) const;
};

/// qx, qy, qz, qw; without them a quaternion by other names, as ROS writes them
/// (pose.orientation.x); without that roll, pitch and yaw, in radians unless a name says degrees.
/// Nothing: no column names one. `problem` says why where several would do, or one is not whole.
struct FoundColumns {
  std::optional<HeldColumns> columns{};
  std::string problem{};
};
[[nodiscard]] FoundColumns find_held_columns(std::span<const std::string_view> names);

}  // namespace palpate::io
