#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace palpate::io {

/// What a column of a file means to us.
enum class Role { x, y, z, normal_x, normal_y, normal_z, red, green, blue, intensity };
inline constexpr std::size_t kRoleCount = 10;

/// One point as read: a value for each role; what the file lacks stays 0.
using Row = std::array<double, kRoleCount>;

[[nodiscard]] constexpr std::size_t index_of(Role role) {
  return static_cast<std::size_t>(role);
}

/// Which optional columns a file has.
struct Columns {
  bool normals = false;
  bool colors = false;
  bool intensities = false;
};

/// The role that a column's name stands for, in the spellings that programs write (any case):
/// x, nx, normal_x, red, r, diffuse_red, intensity, scalar_intensity, quality, ...
[[nodiscard]] std::optional<Role> role_of(std::string_view name);

/// The optional columns that are complete among `has`, one flag a role.
[[nodiscard]] Columns complete_columns(const std::array<bool, kRoleCount>& has);

}  // namespace palpate::io
