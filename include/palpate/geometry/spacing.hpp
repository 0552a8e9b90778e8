#pragma once

#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Spacing when no two points differ, m: there is nothing to measure (judgement).
inline constexpr double kLoneSpacing = 1e-3;

/// The paper's s: the mean over all points of the mean distance to their three nearest other points
/// (fewer in smaller clouds), m. Exact; neighbours at the same position count with distance zero.
/// kLoneSpacing when no two points differ.
[[nodiscard]] double mean_spacing(const CellGrid& grid);

/// Spacing from area for each point, in sorted order, m: the side of the square that a point has to
/// itself on a surface, from the mean squared distance of its eight nearest others (a position
/// counts once), exact on a square grid, and averaged over its neighbourhood (by 0.75
/// to 1.5). Finite and positive always: with fewer than eight others, too few for an area, a fifth
/// of the distance to the nearest, with none the kLoneSpacing.
///
/// A point beside a surface that is sampled much more densely gets twice that surface's spacing at
/// most, so that an outlier does not reach far.
[[nodiscard]] std::vector<float> local_spacings(const CellGrid& grid);

/// The median; 0 of none.
[[nodiscard]] double median(std::span<const float> values);

}  // namespace palpate
