// Points that are evidence of no surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "prepare/surfels.hpp"

namespace palpate {

/// 1 for each point that is farther from others than most, has none within `typical`, and whose
/// nearest positions lie neither on a surface nor along a line, nor around it on several surfaces.
/// `spacings`: of the points, `typical`: their median, m. In sorted order.
[[nodiscard]] std::vector<std::uint8_t> find_outliers(const CellGrid& grid,
                                                      std::span<const float> spacings,
                                                      double typical);

/// Looks for outliers, and gives them an R that does not reach what is sampled finely.
void refine_outliers(Surfels& surfels);

/// Lets outliers beside a surface weigh nothing. Its points are their neighbours, so
/// find_outliers() of all points passes them over; here it looks at the points on no segment among
/// themselves. A point with another within the typical spacing stays: tips and ridges are on no
/// segment either.
void refine_outliers_off_segments(Surfels& surfels);

}  // namespace palpate
