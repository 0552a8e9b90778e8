#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "io/input.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/io/files.hpp"

namespace palpate::io {

/// Meaning of a file's column.
enum class Role { x, y, z, normal_x, normal_y, normal_z, red, green, blue, intensity };
inline constexpr std::size_t kRoleCount = 10;

/// Values of a point as read, one for each role; 0 for those that the file lacks.
using Row = std::array<double, kRoleCount>;

[[nodiscard]] constexpr std::size_t index_of(Role role) {
  return static_cast<std::size_t>(role);
}

/// Presence of each optional column in a file.
struct Columns {
  bool normals = false;
  bool colors = false;
  bool intensities = false;
};

/// The role that a column's name stands for, in the spellings that programs write (any case):
/// x, nx, normal_x, red, r, diffuse_red, intensity, scalar_intensity, quality, ...
[[nodiscard]] std::optional<Role> role_of(std::string_view name);

/// The same where no columns are called x, y and z: easting, northing and height, Points:0 ...
[[nodiscard]] std::optional<Role> fallback_role_of(std::string_view name);

/// The roles of a file's columns, in their order.
class Roles {
 public:
  /// Adds the next column's role; none if an earlier column has it already.
  void add(std::optional<Role> role);

  [[nodiscard]] std::size_t size() const { return roles_.size(); }
  [[nodiscard]] std::optional<Role> operator[](std::size_t column) const { return roles_[column]; }
  /// Are there x, y and z?
  [[nodiscard]] bool has_point() const { return has(Role::x, 3); }
  /// The optional columns that are complete.
  [[nodiscard]] Columns columns() const;

 private:
  /// Are there so many roles that follow one another?
  [[nodiscard]] bool has(Role first, std::size_t count) const;

  std::vector<std::optional<Role>> roles_;
  std::array<bool, kRoleCount> has_{};
};

/// Coordinates beyond this many metres occur in no survey, and their squares would leave
/// the range of float; a point that has one is dropped like one that is not finite.
inline constexpr double kLargestCoordinate = 1e12;

[[nodiscard]] inline bool is_usable(const Eigen::Vector3d& point) {
  return (point.array().abs() <= kLargestCoordinate).all();  // false for NaN as well
}

/// The origin for a cloud: zero where floats around zero lose at most four bits, otherwise a round
/// point (1, 10, 100 ... metres, as the cloud's size is) near the median. Medians, of a sample of
/// about a thousand points, because one outlier at zero must not cost a survey its digits.
/// @param point_at the i-th of `count` points in metres; points that are not usable are left out.
[[nodiscard]] Eigen::Vector3d choose_origin(
    std::size_t count, const std::function<Eigen::Vector3d(std::size_t)>& point_at);

/// In what measure colours are given.
enum class ColorScale {
  byte,   ///< 0 ... 255
  guess,  ///< by the largest: 0 ... 1 (of numbers that may have fractions), 0 ... 255, or 65535
  guess_integer  ///< by the largest: 0 ... 255, or 65535
};

/// Collects rows and makes a cloud of them: scales, drops what is not finite, chooses the origin,
/// makes normals unit, brings colours to bytes.
class CloudBuilder {
 public:
  /// `expected` points are given room; it must be backed by bytes that are really there.
  CloudBuilder(const Input& input, const Columns& columns, ColorScale color_scale,
               std::size_t expected);

  /// Declares that rows are the pixels of an image. Before any is added.
  void organise(std::size_t width, std::size_t height);

  void add(const Row& row);

  /// Points kept so far.
  [[nodiscard]] std::size_t size() const { return points_.size(); }

  /// The cloud in a CloudFile whose `declared` is what add() has seen. Leaves the builder empty.
  /// @throws Error when no point is left.
  [[nodiscard]] CloudFile finish(std::string format);

 private:
  [[nodiscard]] Eigen::Vector3f normal_of(const Row& row) const;
  void split_positions(PointCloud& cloud);
  void convert_colors(PointCloud& cloud) const;

  const Input& input_;
  Columns columns_;
  ColorScale color_scale_;
  std::size_t dropped_ = 0;
  std::vector<Eigen::Vector3d> points_;  // m
  std::vector<std::array<float, 3>> colors_;
  PointCloud cloud_;
};

/// A normal made unit; zero where it is not finite or has no length. One that is unit to a few
/// millionths stays as it is, bit for bit.
[[nodiscard]] Eigen::Vector3f unit_normal(const Eigen::Vector3d& normal);

/// Colours brought to bytes; see ColorScale.
[[nodiscard]] std::vector<std::array<std::uint8_t, 3>> byte_colors(
    const std::vector<std::array<float, 3>>& colors, ColorScale scale);

/// @throws Error unless scale and length of the options are finite numbers above zero, and the
/// mesh's spacing is one that is not below. A length and a spacing exclude each other.
void check_options(const Input& input);

/// @throws Error when a file had points but none that can be used, or none at all.
void check_not_empty(const Input& input, std::size_t kept, std::size_t dropped);

/// Multiplies all lengths of a cloud.
void rescale(PointCloud& cloud, double factor);

/// The same of a file, with its unit and the spacings that are reported of it.
void rescale(CloudFile& file, double factor);

}  // namespace palpate::io
