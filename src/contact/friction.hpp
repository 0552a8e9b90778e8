#pragma once

#include <Eigen/Core>

#include "palpate/contact/proxy.hpp"

namespace palpate {

/// Friction in one step, as lengths of the spring between proxy and hand: what a force is, divided
/// by K (docs/method.md 4.1).
struct FrictionLaw {
  double static_coefficient = 0;
  double dynamic_coefficient = 0;
  double viscous_rate = 0;  ///< b_v / dt, N/m
  double stiffness = 0;     ///< K, N/m

  [[nodiscard]] bool any() const noexcept { return static_coefficient > 0 || viscous_rate > 0; }
};

/// `factor` scales all three coefficients.
[[nodiscard]] FrictionLaw friction_law(const Friction& friction, double factor, double stiffness,
                                       double dt) noexcept;

/// Does the surface hold the proxy, when the spring is stretched by `normal` into the surface and
/// by `tangential` along it (m)?
[[nodiscard]] bool sticks(const FrictionLaw& law, bool sliding, double normal,
                          double tangential) noexcept;

/// The stretch along the surface that remains after the proxy has slid as far as friction lets it,
/// m, in [0, tangential]. `moved`: what it has slid in this step already, m.
[[nodiscard]] double held_stretch(const FrictionLaw& law, double normal, double tangential,
                                  double moved) noexcept;

/// The height that a texture adds to the surface and its gradient; the height is never above 0.
struct Relief {
  double height = 0;  ///< m, in [-2 amplitude, 0]
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// The relief at x (m, world).
[[nodiscard]] Relief relief_at(const Texture& texture, const Eigen::Vector3d& x) noexcept;

}  // namespace palpate
