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

/// Does a ball that no patch covers certainly hold nothing? Walks through the index itself and
/// gives up, with `false`, as soon as the weights could make a surface or when `visits`, of which
/// every cell and point takes one, have run out. The same bound as is_free() for a patch
/// (docs/method.md 2.10). `radius`: of all points, m; 0: each has its own.
[[nodiscard]] bool is_free_space(const ImplicitSurface& surface,
                                 std::span<const ActiveLayer> layers, int sources, const Ball& ball,
                                 double radius, int& visits) noexcept;

}  // namespace palpate
