#pragma once

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

}  // namespace palpate
