#pragma once

#include <algorithm>
#include <cmath>

namespace palpate::depth {

/// Depths in steps of a fourth of an octave from 0.1 m on: narrow enough that sigma(z) z0^2 / z^2
/// is the same all over a bin for sensors that match patterns.
inline constexpr int kNoiseBins = 32;

[[nodiscard]] inline int noise_bin(double z) {
  return std::clamp(static_cast<int>(std::floor(4 * std::log2(z / 0.1))), 0, kNoiseBins - 1);
}

/// What is measured at one depth.
struct NoiseSample {
  double z = 0;       ///< m
  double sigma = 0;   ///< m
  double weight = 0;  ///< how many windows or tiles say so
};

}  // namespace palpate::depth
