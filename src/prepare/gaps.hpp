// Between the fourth and the fifth step of prepare(): larger R, and planes, where points are
// sparse.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "palpate/prepare/prepare.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/sheets.hpp"
#include "prepare/weights.hpp"

namespace palpate {

/// Closes gaps where radii and planes are chosen by preparation. Returns the sums of weights that
/// the radii give then.
[[nodiscard]] WeightSums close_gaps(const PrepareOptions& options, Sampling& sampling, Radii& radii,
                                    PointFits& fits);

/// Raises the support radii (m) of points that hardly any other's support reaches, though others
/// lie on opposite sides of them, to 2.5 times the way to those, where one sheet goes on over the
/// gap; that sheet becomes the point's own, and the way its spacing. Beside far denser points (a
/// handful of near-duplicates is enough) spacings and limit_growth() make R too small, which tears
/// a hole. A stray point has all others on one side and keeps its radius; so does the corner of a
/// sheet. None is raised above `largest`, m. Returns how many were raised. Does not depend on the
/// number of threads.
std::size_t close_gaps(const CellGrid& grid, std::span<const float> sums,
                       std::vector<float>& spacings, std::vector<float>& radii, PointFits& own,
                       float largest = std::numeric_limits<float>::infinity());

}  // namespace palpate
