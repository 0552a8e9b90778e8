// The last step of prepare(): columns become SurfacePoints and a report.
#pragma once

#include <span>

#include "palpate/prepare/prepare.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/weights.hpp"
#include "refine/sheets.hpp"

namespace palpate {

/// Moves all columns into their places; adds the twins; completes the `report`.
[[nodiscard]] Prepared assemble(Sampling sampling, Radii radii, PointFits fits, Weights weights,
                                JoinedSheets joined, const PrepareOptions& options,
                                Prepared::Report report);

/// Finishes points whose columns are whole, and reports on their radii and trust.
void complete(Prepared& prepared);

/// Puts points that lie on two sheets on both, with half their weight each: a sheet that lacks the
/// points of its crease would give way there. Indexes the points again.
void add_twins(std::span<const Twin> twins, SurfacePoints& points);

}  // namespace palpate
