// Finds by brute force where half of the light is gone in a scene of splats.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "support/splat_scenes.hpp"

namespace palpate::test {

/// The height above `place`, along its normal, at which half of the light is gone that comes
/// against the normal: every splat of the scene, front to back, each where it shows most on that
/// line, as renderers draw them. Looks `reach` to both sides, m. Nothing where more than half gets
/// through.
inline std::optional<double> half_light_at(std::span<const Splat> splats, const SurfacePlace& place,
                                           double reach) {
  std::vector<std::pair<double, double>> met;  // heights and opacities
  for (const Splat& splat : splats) {
    const Eigen::Matrix3d axes = splat.rotation.toRotationMatrix().cast<double>();
    const Eigen::Vector3d in_sigmas = splat.sigma.cast<double>().cwiseInverse();
    const Eigen::Vector3d away = place.position - splat.position.cast<double>();
    const Eigen::Vector3d from = in_sigmas.cwiseProduct(axes.transpose() * away);
    const Eigen::Vector3d along = in_sigmas.cwiseProduct(axes.transpose() * place.normal);
    const double height = -from.dot(along) / along.squaredNorm();
    const double square = (from + height * along).squaredNorm();
    const double opacity =
        std::min(0.99, static_cast<double>(splat.opacity) * std::exp(-square / 2));
    if (opacity >= 1. / 255 && std::abs(height) <= reach) met.emplace_back(height, opacity);
  }
  std::ranges::sort(met, std::greater());
  double left = 1;
  for (const auto& [height, opacity] : met) {
    left *= 1 - opacity;
    if (left <= 0.5) return height;
  }
  return std::nullopt;
}

/// The mean of it over places that `draw` gives, m.
template <class Draw>
double mean_half_light(std::span<const Splat> splats, double reach, const Draw& draw) {
  constexpr int kPlaces = 200;
  double sum = 0;
  int count = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const std::optional<double> height = half_light_at(splats, draw(), reach);
    sum += height.value_or(0);
    count += height ? 1 : 0;
  }
  return sum / count;
}

}  // namespace palpate::test
