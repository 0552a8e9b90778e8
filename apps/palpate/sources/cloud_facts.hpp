#pragma once

#include <span>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate::app {

/// Are they all at one position or on a line, where no surface is? So are none.
[[nodiscard]] bool on_a_line(std::span<const Eigen::Vector3f> points);

/// How far points are from one another, m; medians over a sample that is spread over the cloud.
struct SpacingFacts {
  double nearest_three = 0;  ///< mean distance to the three nearest others
  double from_area = 0;      ///< side of the square that a point has to itself
};

[[nodiscard]] SpacingFacts measure_spacing(const CellGrid& grid);

/// Share of points, 0-1, at a rim: a border of the cloud or of a hole in it. A point is at a rim if
/// the mean of its neighbours within R lies more than R / 4 away from it: 0 inside an even surface,
/// 0.42 R at a straight border.
[[nodiscard]] double rim_share(const SurfacePoints& points);

}  // namespace palpate::app
