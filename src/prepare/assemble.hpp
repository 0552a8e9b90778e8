// The last step of prepare(): columns become SurfacePoints and a report.
#pragma once

#include "palpate/prepare/prepare.hpp"
#include "prepare/surfels.hpp"

namespace palpate {

/// Moves all columns of `surfels` into its `prepared` points.
void assemble(Surfels& surfels);

/// Finishes points whose columns are whole, and reports on their radii and trust.
void complete(Prepared& prepared);

}  // namespace palpate
