// Points that lie on two sheets are on both.
#pragma once

#include <span>

#include "palpate/field/surface_points.hpp"
#include "prepare/surfels.hpp"

namespace palpate {

/// Puts points that lie on two sheets on both, with half their weight each: a sheet that lacks the
/// points of its crease would give way there. Indexes the points again.
void add_twins(std::span<const Twin> twins, SurfacePoints& points);

/// add_twins() of the surfels.
void refine_twins(Surfels& surfels);

}  // namespace palpate
