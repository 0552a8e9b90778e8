#pragma once

#include <functional>
#include <vector>

#include "palpate/field/analytic.hpp"
#include "sim/simulated_depth.hpp"

namespace palpate::any_cloud {

/// A solid by its signed distance and the gradient of that. Lengths of a scene are in spacings of
/// its points, in the scene's own frame.
using Shape = std::function<Distance(const Eigen::Vector3d&)>;

/// All that lies behind the plane through `point`.
[[nodiscard]] Shape half_space(const Eigen::Vector3d& point, const Eigen::Vector3d& outward);
[[nodiscard]] Shape of(const Solid& solid);
/// Around the origin.
[[nodiscard]] Shape ball(double radius);
[[nodiscard]] Shape box(const Eigen::Vector3d& center, const Eigen::Vector3d& size);
/// All within `radius` of the straight line from a to b.
[[nodiscard]] Shape rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius);
/// A tube around a circle in the plane z = 0.
[[nodiscard]] Shape torus(double ring, double tube);
/// A polygon in the plane of x and z, endless along y.
[[nodiscard]] Shape extruded(std::vector<Eigen::Vector2d> polygon);

/// Exact but for creases, which are filled by up to 0.025 (a quadratic smooth minimum); inside both
/// no deeper than it is.
[[nodiscard]] Shape unite(Shape a, Shape b);

}  // namespace palpate::any_cloud
