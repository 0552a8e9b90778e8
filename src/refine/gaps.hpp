// The refinement that gives larger R, and planes, where points are sparse.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "palpate/geometry/cell_grid.hpp"
#include "prepare/surfels.hpp"

namespace palpate {

/// Closes gaps where radii and planes are chosen by preparation, and brings the sums of weights up
/// to the new radii.
void refine_gaps(Surfels& surfels);

/// Raises the support radii (m) of points beside holes in their segment that supports do not
/// bridge, where one segment goes on over the hole: to those of the square grid with holes as wide
/// or, where no segment goes on so far, to 2.5 times the hole's radius. That segment becomes the
/// point's own. Clusters of points, points that lie anywhere and triangles of many sizes leave
/// holes wider than spacings show; beside far denser points limit_radii() makes R too small. An
/// outlier has all others on one side and keeps its radius; so does the border of a segment. Holes
/// whose radius is above 0.8 R stay, except around points that hardly any other's support reaches,
/// where those above 3 R do. `sums`: WeightSums::own; `noise`: of each point, m. None is raised
/// above `largest`, m. The graph holds R. Returns how many were raised. Does not depend on the
/// number of threads.
std::size_t close_gaps(const detail::NeighborhoodGraph& graph, std::span<const float> sums,
                       std::span<const float> noise, std::vector<float>& spacings,
                       std::vector<float>& radii, PointFits& own,
                       float largest = std::numeric_limits<float>::infinity());

}  // namespace palpate
