#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "palpate/depth/depth_filter.hpp"

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

/// What a quadratic surface leaves of a square of values, in squares of their unit.
struct WindowNoise {
  float variance = 0;  ///< of one value; 0: they are too few, show no one surface, or do not vary
  /// Mean square of the four cubic terms' coefficients, orthonormal: the variance of one value if
  /// values err alone, and n_c times that where windows are much larger than what errs together.
  float power = 0;
  float mean = 0;  ///< of the surface
};

/// Fits quadratic surfaces to squares of one size, whatever up to a quarter of the values are.
class NoiseFit {
 public:
  /// `size`: values along a side, at most kLargest.
  explicit NoiseFit(int size);

  static constexpr int kLargest = 40;
  static constexpr int kTerms = 6;

  [[nodiscard]] int size() const { return size_; }

  /// `values`: row by row, NaN where there is none.
  WindowNoise fit(std::span<const float> values);

 private:
  static constexpr std::size_t kDegrees = 4;
  using Row = std::array<float, kLargest>;
  using Coefficients = std::array<std::array<float, kDegrees>, kDegrees>;  // by degrees in u, v

  void subtract(std::span<const float> values, const Coefficients& surface);
  [[nodiscard]] float typical_residual();
  [[nodiscard]] Coefficients project(float limit);

  int size_;
  std::array<Row, kDegrees> polynomials_{};  // orthonormal over the places of a row
  std::vector<float> residuals_;             // NaN where there is no value
  std::vector<float> sorted_;
  float reference_ = 0;  // that values count from
  int inside_ = 0;       // values whose residuals project() has found to be within its limit
  double squares_ = 0;   // of these
};

}  // namespace palpate::depth
