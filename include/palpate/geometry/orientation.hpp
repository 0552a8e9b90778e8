#pragma once

#include <Eigen/Core>
#include <span>

#include "palpate/geometry/cell_grid.hpp"

namespace palpate {

/// Turns each normal to the side where `viewpoint` is. Normals seen edge-on stay as they are.
/// Points and viewpoint in one frame, m.
/// @throws Error when there are not as many normals as points.
void orient_to_viewpoint(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& viewpoint,
                         std::span<Eigen::Vector3f> normals);

/// Turns the normals of sorted points so that neighbours agree, and each connected part outward:
///
/// - Neighbours i, j agree when n_i, mirrored by the plane halfway between them, looks like n_j:
///   then a round arc joins the two. Opposite sides of a thin plate so get opposite normals. Votes
///   of all pairs between two patches add up, and the patches that are surest merge first.
/// - A part that closes around something (its normals cancel: |sum a n| <= 0.3 sum a, a a point's
///   area) has its normals turned so that the volume it holds is positive.
/// - An open part, such as terrain, a wall or one view of a scene, has no outside. Its mean normal
///   turns up (+z) where it leans more than 12 degrees from the horizontal, and else away from the
///   centre of all points.
///
/// `spacings` are the points' own, as local_spacings() gives them, m: parts further apart than 1.6
/// of them are not connected. Zero normals stay zero. Takes time in proportion to the points (a
/// second for two million on one core) and is the same for any number of threads.
/// @throws Error when there are not as many normals or spacings as points.
void orient_outward(const CellGrid& grid, std::span<const float> spacings,
                    std::span<Eigen::Vector3f> normals);

/// The same, with spacings measured here.
void orient_outward(const CellGrid& grid, std::span<Eigen::Vector3f> normals);

}  // namespace palpate
