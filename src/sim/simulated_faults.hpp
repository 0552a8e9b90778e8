#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/simulated_noise.hpp"

namespace palpate::sim {

/// Depths (m, row by row, 0: none) to look at.
struct DepthView {
  int width;
  int height;
  const float* depth;

  [[nodiscard]] bool inside(int u, int v) const {
    return u >= 0 && v >= 0 && u < width && v < height;
  }
  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * width + u];
  }
};

// What SimulatedNoiseOptions says, from `exact` into its copy `depth`.
void bend_rims(const DepthView& exact, const SimulatedNoiseOptions& options, float* depth);
void mix_rims(const DepthView& exact, const SimulatedNoiseOptions& options, float* depth);
void disturb_silhouettes(const DepthView& exact, std::uint64_t seed, bool far_side, float* depth);
void punch_holes(const DepthView& exact, const SimulatedNoiseOptions& options, std::uint64_t frame,
                 float* depth);

}  // namespace palpate::sim
