// The box of a cloud without its outermost points.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "palpate/geometry/shapes.hpp"

namespace palpate::detail {

/// The tight box of the points, of which so many at either end of each axis may lie outside.
/// `outermost`: fewer than half of the points.
[[nodiscard]] Box inner_box(std::span<const Eigen::Vector3f> points, std::size_t outermost);

}  // namespace palpate::detail
