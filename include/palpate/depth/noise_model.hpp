#pragma once

#include <array>

namespace palpate {

/// How a depth camera errs: sigma(z) = s0 + s1 z + s2 z^2 along the optical axis for one pixel, and
/// how much neighbouring pixels err together.
struct NoiseModel {
  std::array<double, 3> coefficients{};  ///< s0 (m), s1, s2 (1/m)
  /// c: error of the mean of many neighbouring pixels over what independent pixels would have;
  /// >= 1. Its square is the sum of the noise's autocorrelation, in pixels.
  double correlation = 1;

  [[nodiscard]] double sigma(double z) const {
    return coefficients[0] + z * (coefficients[1] + z * coefficients[2]);
  }
};

}  // namespace palpate
