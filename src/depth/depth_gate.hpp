#pragma once

#include <algorithm>
#include <cmath>

#include "depth/block_grid.hpp"
#include "depth/simd/plain.hpp"
#include "palpate/depth/depth_filter.hpp"

namespace palpate::depth {

/// What depths of one surface may differ by: three deviations of a pixel, and what `pixels` between
/// them make of a surface that is seen at an incidence of 72 degrees.
[[nodiscard]] inline simd::DepthGate depth_gate(const BlockGrid& grid, float pixels,
                                                const NoiseModel& noise,
                                                const DepthFilterOptions& range) {
  constexpr float kDeviations = 3;
  constexpr float kSteepest = 3;  // tangent of the incidence
  const auto& s = noise.coefficients;
  const double pixel = std::max(std::abs(grid.step_x), std::abs(grid.step_y)) / 2;
  return {static_cast<float>(range.nearest),
          static_cast<float>(range.farthest),
          {static_cast<float>(kDeviations * s[0]),
           static_cast<float>(kDeviations * s[1] + kSteepest * pixels * pixel),
           static_cast<float>(kDeviations * s[2])}};
}

}  // namespace palpate::depth
