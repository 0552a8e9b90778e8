// The field at one position, evaluated from a patch of points (docs/method.md 2).
#pragma once

#include <span>

#include "field/patch.hpp"
#include "field/simd/sums.hpp"
#include "palpate/field/field.hpp"
#include "palpate/field/field_options.hpp"

namespace palpate {

/// The options of a field with what follows from them once and for all.
struct ImplicitSurface {
  /// @throws Error when an option is out of its range.
  explicit ImplicitSurface(const FieldOptions& options);

  /// Real-time. `checked`: check() has passed it.
  void change(const FieldOptions& checked) noexcept;

  FieldOptions options;
  double offset = 0;        ///< of the metaball level, in support radii, without a tool
  double largest_tool = 0;  ///< that the metaball's surface is pushed out by, in support radii
  Rise rise;                ///< of the surface over points of a plane
  const simd::Functions* sums;
};

/// The field at x, from the points of a patch that covers x.
[[nodiscard]] Sample evaluate(const ImplicitSurface& surface, const Patch& patch,
                              const Eigen::Vector3d& x) noexcept;

/// The (united) weight sum below which nothing is solid, where no support radius is below
/// `smallest_radius`.
[[nodiscard]] double free_level(const ImplicitSurface& surface, double smallest_radius) noexcept;

/// Does the patch, which covers the ball, hold nothing in it?
[[nodiscard]] bool is_free(const ImplicitSurface& surface, const Patch& patch,
                           const Ball& ball) noexcept;

/// (sum w_s^4)^(1/4): how the weight sums of several sources unite (docs/method.md 2.9).
[[nodiscard]] double united(const double* w, int sources) noexcept;

/// Weighted means over a patch's points at a position.
struct PatchSurface {
  double material = 1;
  /// Presence of the points times that of their sources, 0-1: min(1, sum_s W_s p_s / max_s W_s).
  /// A surface that one source is confident of keeps its presence when other sources fade.
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
