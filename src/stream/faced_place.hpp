#pragma once

#include <Eigen/Core>
#include <optional>

#include "palpate/geometry/point_cloud.hpp"

namespace palpate {

/// A place that all normals of a cloud face but a hundredth, with all points on one side of it, as
/// a camera has them, and few hidden from it; the cloud's frame, m, in few digits. It is as far
/// from the points' tangent planes as one can be, to a factor of three. None: the cloud has no
/// normals, or they face no such place, as those of a closed body do not, whichever way somebody
/// turned them. Proves nothing: normals of a sheet that are turned over face a place, too.
[[nodiscard]] std::optional<Eigen::Vector3d> faced_place(const PointCloud& cloud);

}  // namespace palpate
