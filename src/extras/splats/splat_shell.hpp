// Makes points on a surface from Gaussian splats.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

/// A Gaussian of a splat scene.
struct Splat {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< m
  Eigen::Vector3f sigma = Eigen::Vector3f::Zero();     ///< along its own axes, m; not negative
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();  ///< of its axes; unit
  float opacity = 0;                                             ///< at its middle, 0 to 1
  std::array<std::uint8_t, 3> color{};                           ///< red, green, blue
};

/// The surface of a splat scene, and how it was found.
struct SplatShell {
  PointCloud cloud;           ///< with normals, zero where a point has none of its own, and colours
  std::size_t visible = 0;    ///< splats of opacity kLeastOpacity and more
  double spacing = 0;         ///< edge of a cell, which holds a point at most, m
  double without_normal = 0;  ///< share of points without a normal, 0 to 1
  std::size_t far = 0;        ///< splats left out, as their middles are beyond the grid
  std::size_t huge = 0;       ///< splats left out, as their samples would be too many
  std::size_t samples = 0;    ///< taken of the others: what time and memory follow
  std::size_t pieces = 0;     ///< groups of fewer than kSmallestPiece cells that were dropped
};

inline constexpr float kLeastOpacity = 0.02F;      ///< fainter splats show nothing (judgement)
inline constexpr std::size_t kSmallestPiece = 60;  ///< cells; smaller ones float (judgement)

/// Samples that a splat may take, on the mean of all in the scene. Splats as they are trained take
/// 40 (measured); so many that 125 000 splats of any kind stay below 0.3 GB.
inline constexpr std::size_t kUsualSamples = 50;

/// The shell of splats (docs/touch.md, "Gaussian splats"): samples them, adds up their optical
/// depth in cells, keeps the cells that light reaches, and draws these together to a sheet where
/// half of the light is gone. Without points where no splat is opaque. Takes kUsualSamples samples
/// a splat at most; what is over of the largest is left out. The result does not depend on the
/// number of threads. `progress` is called with 0 ... 1 now and then; it may throw to give up.
[[nodiscard]] SplatShell shell_of(std::span<const Splat> splats,
                                  const std::function<void(double)>& progress = {});

}  // namespace palpate
