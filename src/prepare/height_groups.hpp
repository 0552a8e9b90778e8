// Heights over a plane that fall into two groups, as those of two surfaces do.
#pragma once

#include <span>

namespace palpate {

/// The middle of the empty gap between two groups of heights (docs/method.md 5.5), m; NaN: they are
/// one group. `spacing`: of the points, m. May sort the heights.
[[nodiscard]] double gap_in(std::span<double> heights, double spacing);

}  // namespace palpate
