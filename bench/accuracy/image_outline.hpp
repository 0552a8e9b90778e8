#pragma once

#include <Eigen/Core>
#include <vector>

#include "accuracy/truth_scene.hpp"

namespace palpate::accuracy {

/// Points of the image, pixels; what they outline is their convex hull.
using Outline = std::vector<Eigen::Vector2d>;

/// Where the camera sees points (m, world) that lie in front of it.
[[nodiscard]] Outline project(const TruthCamera& camera,
                              const std::vector<Eigen::Vector3d>& points);

/// Points (m, world) around all of a bounded solid that is above the table.
[[nodiscard]] std::vector<Eigen::Vector3d> hull_above_table(const Solid& solid);

/// Points (m) of the table around `center`, all at the distance `radius`.
[[nodiscard]] std::vector<Eigen::Vector3d> circle_on_table(const Eigen::Vector3d& center,
                                                           double radius);

/// Is it all seen, `margin` pixels from the image's border and more?
[[nodiscard]] bool inside_image(const TruthCamera& camera, const Outline& outline, double margin);

/// True only if `margin` pixels and more lie between the two: then neither hides the other.
[[nodiscard]] bool apart(const Outline& a, const Outline& b, double margin);

}  // namespace palpate::accuracy
