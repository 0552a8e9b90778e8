#pragma once

#include "field/evaluate.hpp"
#include "field/patch.hpp"

namespace palpate {

/// Weighted means over a patch's points at a place.
struct PatchSurface {
  double material = 1;
  double presence = 1;                                 ///< of the points, without the sources' own
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  int source = -1;                                     ///< that weighs most; -1: no point is near
};

[[nodiscard]] PatchSurface mean_surface(const ImplicitSurface& surface, const Patch& patch,
                                        const Eigen::Vector3d& x) noexcept;

}  // namespace palpate
