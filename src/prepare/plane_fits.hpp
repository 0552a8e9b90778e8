// The fourth step of prepare(): the plane of each point.
#pragma once

#include <span>

#include "palpate/prepare/prepare.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/sheets.hpp"

namespace palpate {

/// Fits the points' planes, lets given normals take part, and finds strays, whose `radii` it makes
/// small. Empty where no normals are asked for.
[[nodiscard]] OwnSheets fit_planes(const Sampling& sampling, const PrepareOptions& options,
                                   Radii& radii);

}  // namespace palpate
