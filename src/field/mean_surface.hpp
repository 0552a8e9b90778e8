#pragma once

#include <span>

#include "field/evaluate.hpp"
#include "field/patch.hpp"

namespace palpate {

/// Weighted means over a patch's points at a place.
struct PatchSurface {
  double material = 1;
  /// Of points times that of their sources: min(1, sum_s W_s p_s / max_s W_s), so that what one
  /// source is sure of stays sure whatever becomes of the others.
  double presence = 1;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  int source = -1;                                     ///< that weighs most; -1: no point is near
};

/// `presences`: of each source, 0-1; empty: all 1.
[[nodiscard]] PatchSurface mean_surface(const ImplicitSurface& surface, const Patch& patch,
                                        const Eigen::Vector3d& x,
                                        std::span<const double> presences = {}) noexcept;

}  // namespace palpate
