// Puts points that lie on two segments on both.
#pragma once

#include <span>

#include "palpate/field/surface_points.hpp"
#include "prepare/surfels.hpp"

namespace palpate {

/// Puts points that lie on two segments on both, with half their weight each: a segment that lacks
/// the points of its crease would yield there. Indexes the points again.
void add_second_planes(std::span<const SecondPlane> second_planes, SurfacePoints& points);

/// add_second_planes() of the surfels.
void refine_second_planes(Surfels& surfels);

}  // namespace palpate
