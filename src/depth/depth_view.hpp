#pragma once

#include <cstddef>
#include <span>

namespace palpate::depth {

/// A depth image that somebody else owns. Depths along the optical axis, m, row by row; whatever
/// is not within nearest ... farthest (0, NaN, infinity too) counts as not measured.
struct DepthView {
  std::span<const float> depth;
  int width = 0;      ///< pixels
  int height = 0;     ///< pixels
  double focal = 0;   ///< pixels
  float nearest = 0;  ///< m
  float farthest = 0;

  [[nodiscard]] float at(int u, int v) const {
    return depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(u)];
  }
  [[nodiscard]] bool valid(float z) const { return z >= nearest && z <= farthest; }
};

}  // namespace palpate::depth
