#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "palpate/geometry/shapes.hpp"

namespace palpate {

/// Points of one sensor or file, in metres, in that sensor's or file's own frame.
///
/// Positions are float offsets from a double-precision origin, so that survey coordinates of
/// 10^6 m and parts of a millimetre both keep their digits. Optional columns are either empty or
/// as long as `positions`.
struct PointCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m
  std::vector<Eigen::Vector3f> positions;            ///< m, relative to `origin`; finite
  std::vector<Eigen::Vector3f> normals;              ///< unit length, or zero where undefined
  std::vector<std::array<std::uint8_t, 3>> colors;   ///< red, green, blue
  std::vector<float> intensities;                    ///< in the file's own scale
  std::optional<Eigen::Vector3d> viewpoint;          ///< where the sensor stood, m, if given

  // Image of an organised cloud, whose points are pixels; else 0, 0 and empty.
  std::size_t width = 0;              ///< columns of the image
  std::size_t height = 0;             ///< rows of the image
  std::vector<std::uint32_t> pixels;  ///< where each point was: row * width + column

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool empty() const { return positions.empty(); }
  [[nodiscard]] Eigen::Vector3d point(std::size_t i) const {
    return origin + positions[i].cast<double>();
  }
};

/// The points of `cloud` named by `indices`, in that order, with all their columns but pixels: they
/// are no image any more. Origin and viewpoint are kept.
[[nodiscard]] PointCloud select(const PointCloud& cloud, std::span<const std::uint32_t> indices);

/// The points inside `box`, its faces included (in the cloud's frame, m), in their order.
[[nodiscard]] PointCloud clip(const PointCloud& cloud, const Box& box);

/// Replaces the points in each cube of side `leaf` (m) by their mean; normals (unit again; zero if
/// they cancel), colours and intensities are averaged, too. Cubes start at whole multiples of
/// `leaf` from the cloud's origin, which is kept, as is the viewpoint. Points come in the order of
/// their cubes, z slowest and x fastest. `counts`, if given, gets the number of points behind each
/// mean.
/// @throws Error when the leaf is not positive and finite, or so small that the cloud is more than
/// 2^21 cubes long (which is where 32-bit indices of other filters have long overflowed), or when a
/// position is not finite.
[[nodiscard]] PointCloud voxel_downsample(const PointCloud& cloud, double leaf,
                                          std::vector<std::uint32_t>* counts = nullptr);

}  // namespace palpate
