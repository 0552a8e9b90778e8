#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "palpate/depth/noise_model.hpp"

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

/// sigma(z) = s0 + s1 z + s2 z^2 through samples, robust against single wrong ones; relative errors
/// count. Fewer terms where the samples span little depth, `prior` times a factor where they span
/// next to none. Positive at all depths, and it neither vanishes before the nearest sample nor
/// falls behind the farthest. Keeps the prior's correlation. No samples: the prior.
[[nodiscard]] NoiseModel fit_noise_curve(std::span<const NoiseSample> samples,
                                         const NoiseModel& prior);

}  // namespace palpate::depth
