#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "io/input.hpp"
#include "io/row.hpp"
#include "palpate/geometry/point_cloud.hpp"
#include "palpate/io/read_cloud.hpp"

namespace palpate::io {

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

  /// Says that rows are the pixels of an image. Before any is added.
  void organise(std::size_t width, std::size_t height);

  void add(const Row& row);

  /// Points kept so far.
  [[nodiscard]] std::size_t size() const { return points_.size(); }

  /// The cloud in a CloudFile whose `declared` is what add() has seen. Leaves the builder empty.
  /// @throws Error when no point is left.
  [[nodiscard]] CloudFile finish(std::string format);

 private:
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
/// parts in a million stays as it is, bit for bit.
[[nodiscard]] Eigen::Vector3f unit_normal(const Eigen::Vector3d& normal);

/// Colours brought to bytes; see ColorScale.
[[nodiscard]] std::vector<std::array<std::uint8_t, 3>> byte_colors(
    const std::vector<std::array<float, 3>>& colors, ColorScale scale);

/// @throws Error unless options.scale is a finite number above zero.
void check_options(const Input& input);

/// @throws Error that says so when a file had points but none that can be used, or none at all.
void check_not_empty(const Input& input, std::size_t kept, std::size_t dropped);

}  // namespace palpate::io
