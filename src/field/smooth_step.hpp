#pragma once

#include <algorithm>

namespace palpate {

/// How far a gate has opened, 0 to 1, with its derivative.
struct SmoothStep {
  double value = 0;
  double slope = 0;
};

/// u^2 (3 - 2u) of u = clamp((x - from) / width, 0, 1): the gates between one surface and another.
[[nodiscard]] inline SmoothStep smooth_step(double x, double from, double width) noexcept {
  const double u = std::clamp((x - from) / width, 0.0, 1.0);
  return {u * u * (3 - 2 * u), 6 * u * (1 - u) / width};
}

}  // namespace palpate
