#pragma once

#include <Eigen/Core>
#include <span>

namespace palpate::rivals {

/// The point nearest to `goal` among all x with n . x >= 0 for each of up to three unit normals n:
/// where a god-object goes that stands at the origin and is held by these planes.
[[nodiscard]] Eigen::Vector3d nearest_allowed(std::span<const Eigen::Vector3d> normals,
                                              const Eigen::Vector3d& goal);

}  // namespace palpate::rivals
