#pragma once

#include <span>
#include <vector>

#include "palpate/geometry/point_cloud.hpp"
#include "palpate/geometry/shapes.hpp"
#include "palpate/prepare/prepare.hpp"

namespace palpate::app {

/// Are they all at one position or on a line, where no surface is? So are none.
[[nodiscard]] bool on_a_line(std::span<const Eigen::Vector3f> points);

/// The mean distance of a point to its three nearest others, m; the median over a sample that is
/// spread over the cloud. 0: there are fewer.
[[nodiscard]] double nearest_three(const CellGrid& grid);

/// The side of the square that a point has to itself, m, from its eight nearest others; the median
/// over such a sample. 0: there are fewer.
[[nodiscard]] double spacing_from_area(const CellGrid& grid);

/// Share of points, 0-1, at a rim: a border of the cloud or of a hole in it. A point is at a rim if
/// the mean of its neighbours within R lies more than R / 4 away from it: 0 inside an even surface,
/// 0.42 R at a straight border.
[[nodiscard]] double rim_share(const SurfacePoints& points);

}  // namespace palpate::app
