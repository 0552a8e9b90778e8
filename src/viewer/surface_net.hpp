#pragma once

#include "viewer/lattice.hpp"
#include "viewer/local_surface.hpp"

namespace palpate::viewer {

/// The surface between positive and other values of a lattice: a vertex in each cell whose corners
/// are all known and differ, in the mean of its edges' crossings; a quadrangle around each edge
/// that the surface crosses. Vertices with less than `least_support` are left out.
[[nodiscard]] Mesh surface_net(const Lattice& lattice, double least_support);

}  // namespace palpate::viewer
