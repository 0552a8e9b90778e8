#pragma once

#include <optional>

#include "palpate/field/surface_points.hpp"

namespace palpate {

/// How far apart two surfaces are where both are there: the median distance, along the normal of
/// `b`, from points of `a` to the nearest point of `b`, m, where they are going. Points count that
/// have a neighbour within three radii whose normal points the same way within 45 degrees; nothing
/// when fewer than 30 of about a thousand that are tried do.
[[nodiscard]] std::optional<double> disagreement(const SurfacePoints& a, const SurfacePoints& b);

}  // namespace palpate
