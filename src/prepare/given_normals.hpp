// Normals that came with the cloud.
#pragma once

#include <Eigen/Core>
#include <span>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The share of normals that are there: files mark missing ones by zeros or NaN. 0 of none.
[[nodiscard]] double share_given(std::span<const Eigen::Vector3f> given);

/// Replaces fitted normals by the given ones that are within 20 degrees of them, whatever their
/// sign, if given ones vary no more from a point to its nearest than fitted ones do. In sorted
/// order.
void take_given_normals(const CellGrid& grid, std::span<const Eigen::Vector3f> given,
                        std::span<Eigen::Vector3f> normals);

}  // namespace palpate
