#pragma once

#include <Eigen/Core>

#include "palpate/scene/scene.hpp"

namespace palpate {

/// What is up in a scene of which nobody says it: +z, or the one of +y and -y along which it stands
/// on a flat base, as what is scanned to be drawn often does. Unit, world frame.
[[nodiscard]] Eigen::Vector3d likely_up(const Scene& scene);

}  // namespace palpate
