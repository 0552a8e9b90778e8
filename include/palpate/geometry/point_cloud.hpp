#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

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
  std::optional<Eigen::Vector3d> viewpoint;          ///< where the sensor stood, m, if known

  // Of an organised cloud, whose points are pixels of an image; else 0, 0 and empty.
  std::size_t width = 0;              ///< columns of the image
  std::size_t height = 0;             ///< rows of the image
  std::vector<std::uint32_t> pixels;  ///< where each point was: row * width + column

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool empty() const { return positions.empty(); }
  [[nodiscard]] Eigen::Vector3d point(std::size_t i) const {
    return origin + positions[i].cast<double>();
  }
};

}  // namespace palpate
