#pragma once

#include <optional>

#include "contact/probe.hpp"

namespace palpate {

/// A place on the surface.
struct SurfacePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< outward, unit
  double radius = 0;                                   ///< R here, m
};

/// The first-order signed distance phi = f / |grad f| at a sample; empty where there is no surface
/// to speak of.
[[nodiscard]] std::optional<double> first_order_distance(const Sample& sample) noexcept;

/// Brings x onto the surface along the gradient (algorithm.md 2.3, newton): at most 11 samples. A
/// last step below 2e-4 R is taken without another sample: what it leaves is of the order of its
/// square, about 4e-8 R, and the normal is that of the place before it.
[[nodiscard]] std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x) noexcept;

/// Likewise where the first sample is known already: at most 10 more.
[[nodiscard]] std::optional<SurfacePoint> project(Probe& probe, const Eigen::Vector3d& x,
                                                  const Sample& first) noexcept;

}  // namespace palpate
