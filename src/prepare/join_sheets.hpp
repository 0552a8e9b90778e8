// The step of prepare() that puts points on sheets and sheets into parts.
#pragma once

#include <vector>

#include "palpate/prepare/prepare.hpp"
#include "prepare/place.hpp"
#include "prepare/radii.hpp"
#include "prepare/sampling.hpp"
#include "prepare/sheets.hpp"
#include "prepare/weigh.hpp"

namespace palpate {

/// The sheets of all points, and the points that lie on two of them.
struct Sheets {
  SurfacePoints::Sheets sheets;
  std::vector<Twin> twins;  ///< in rising order
};

/// make_sheets() of the points that weigh something. None where there are no fits.
[[nodiscard]] Sheets join_sheets(const Sampling& sampling, const Radii& radii,
                                 const Weights& weights, const KnownSigns& known, OwnSheets& fits);

/// What the options let sheets know of signs.
[[nodiscard]] KnownSigns given_signs(const Placed& placed, const Sampling& sampling,
                                     const PrepareOptions& options);

}  // namespace palpate
