#pragma once

#include <Eigen/Core>
#include <span>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// The share of normals that say something: files mark missing ones by zeros or by no numbers. 0 of
/// none.
[[nodiscard]] double share_given(std::span<const Eigen::Vector3f> given);

/// Turns each normal to the side of the one that is given for its point. Where that is missing, to
/// the side that most given ones within the point's radius are on, the nearest counting most; then
/// to that of neighbours that were turned before, round by round; and, where nothing given is
/// connected, outward. All in sorted order, m. Does not depend on the number of threads.
void orient_as_given(const CellGrid& grid, std::span<const Eigen::Vector3f> given,
                     std::span<const float> spacings, std::span<const float> radii,
                     std::span<Eigen::Vector3f> normals);

}  // namespace palpate
