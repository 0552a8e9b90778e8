#pragma once

#include <cstdint>

#include "accuracy/depth_camera.hpp"

namespace palpate::accuracy {

/// The three kinds of noise of evaluation.md. All have the standard deviation depth_sigma(z).
enum class NoiseKind {
  independent,  ///< (a) in each pixel for itself
  blurred,      ///< (b) white noise after a Gaussian blur of 2 pixels
  quantised,    ///< (c) after one of 4 pixels, and then quantised in disparity
};

struct NoiseOptions {
  NoiseKind kind = NoiseKind::independent;
  std::uint64_t seed = 0;
  bool silhouettes = false;  ///< pixels at depth jumps are missing or lie between the two depths
};

/// sigma(z) = 0.0012 + 0.0019 (z - 0.4)^2, all in m.
[[nodiscard]] double depth_sigma(double z);

/// White noise of variance 1, blurred by a Gaussian of `blur` pixels and scaled back to variance 1.
[[nodiscard]] DepthImage unit_noise(int width, int height, double blur, std::uint64_t seed);

/// What a sensor would have measured, rounded to 1 mm.
[[nodiscard]] DepthImage add_noise(const DepthImage& exact, const NoiseOptions& options);

}  // namespace palpate::accuracy
