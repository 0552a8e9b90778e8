#pragma once

#include <Eigen/Core>

#include "palpate/scene/scene.hpp"

namespace palpate {

/// Guesses the up axis: +z, unless the scene stands on a flat base along +y or -y (common in
/// graphics scans). Unit, world frame.
[[nodiscard]] Eigen::Vector3d likely_up(const Scene& scene);

}  // namespace palpate
